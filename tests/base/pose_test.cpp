#include "base/pose.h"

#include "base/random.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>

namespace atlaswire {
namespace {

using namespace std::chrono_literals;

constexpr double kPi = 3.14159265358979323846;

glm::dquat about(const glm::dvec3& axis, double angle) {
  return {std::cos(angle / 2), glm::normalize(axis) * std::sin(angle / 2)};
}

/// Angle between two orientations, radians.
double apart(const glm::dquat& a, const glm::dquat& b) {
  const glm::dquat turn = b * glm::conjugate(a);
  return 2 * std::atan2(glm::length(glm::dvec3(turn.x, turn.y, turn.z)), std::abs(turn.w));
}

TEST(Extrapolate, MovesAndTurnsLinearly) {
  Pose pose;
  pose.position = {1, 2, 3};
  pose.velocity = {2, 0, -4};
  pose.angular_velocity = {0, kPi, 0};
  const Pose later = extrapolate(pose, 500ms);
  EXPECT_NEAR(glm::distance(later.position, {2, 2, 1}), 0, 1e-12);
  EXPECT_NEAR(apart(later.orientation, about({0, 1, 0}, kPi / 2)), 0, 1e-12);
  // A quarter turn to the left about +Y: what looked down -Z looks down -X.
  EXPECT_NEAR(glm::distance(later.orientation * glm::dvec3(0, 0, -1), {-1, 0, 0}), 0, 1e-12);
  EXPECT_EQ(later.velocity, pose.velocity);
  EXPECT_EQ(later.angular_velocity, pose.angular_velocity);
}

TEST(Extrapolate, TurnsAboutSceneAxesWhateverTheOrientation) {
  Pose pose;
  pose.orientation = about({1, 0, 0}, 1.0);
  pose.angular_velocity = {0, 1, 0};
  const Pose later = extrapolate(pose, 1s);
  EXPECT_NEAR(apart(later.orientation, about({0, 1, 0}, 1.0) * pose.orientation), 0, 1e-12);
}

TEST(Extrapolate, BackwardsUndoesForwards) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const auto draw = [&] { return glm::dvec3(random.normal(), random.normal(), random.normal()); };
    Pose pose{draw(), about(draw(), random.uniform()), draw(), draw()};
    const Pose back = extrapolate(extrapolate(pose, 80ms), -80ms);
    EXPECT_NEAR(glm::distance(back.position, pose.position), 0, 1e-12);
    EXPECT_NEAR(apart(back.orientation, pose.orientation), 0, 1e-7);
  }
}

TEST(Extrapolate, StandsStillWithoutVelocity) {
  Pose pose;
  pose.position = {5, 6, 7};
  const Pose later = extrapolate(pose, 10s);
  EXPECT_EQ(later.position, pose.position);
  EXPECT_EQ(later.orientation, pose.orientation);
}

TEST(Interpolate, MeetsItsEndsAndGoesTheShortWay) {
  Pose a;
  Pose b;
  b.position = {4, 0, 0};
  b.orientation = -about({0, 1, 0}, 1.0);  // the same rotation with the other sign
  b.velocity = {2, 2, 2};
  EXPECT_NEAR(apart(interpolate(a, b, 0).orientation, a.orientation), 0, 1e-7);
  EXPECT_NEAR(apart(interpolate(a, b, 1).orientation, b.orientation), 0, 1e-7);
  const Pose middle = interpolate(a, b, 0.25);
  EXPECT_NEAR(apart(middle.orientation, about({0, 1, 0}, 0.25)), 0, 1e-7);
  EXPECT_NEAR(glm::distance(middle.position, {1, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(glm::distance(middle.velocity, {0.5, 0.5, 0.5}), 0, 1e-12);
}

TEST(SetVelocities, ExtrapolationFollowsTheMotionTheyWereTakenFrom) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const auto draw = [&] { return glm::dvec3(random.normal(), random.normal(), random.normal()); };
    const Pose a{draw(), about(draw(), 3 * random.uniform()), {}, {}};
    Pose b{draw(), about(draw(), 3 * random.uniform()), {}, {}};
    set_velocities_from(a, b, 40ms);
    Pose moving = a;
    moving.velocity = b.velocity;
    moving.angular_velocity = b.angular_velocity;
    const Pose reached = extrapolate(moving, 40ms);
    EXPECT_NEAR(glm::distance(reached.position, b.position), 0, 1e-9);
    EXPECT_NEAR(apart(reached.orientation, b.orientation), 0, 1e-7);
  }
}

TEST(SetVelocities, AreZeroWithoutElapsedTime) {
  const Pose a;
  Pose b;
  b.position = {1, 1, 1};
  b.velocity = {9, 9, 9};
  set_velocities_from(a, b, 0ns);
  EXPECT_EQ(b.velocity, glm::dvec3(0));
  set_velocities_from(a, b, -1ms);
  EXPECT_EQ(b.velocity, glm::dvec3(0));
}

TEST(IsSane, RejectsWhatNoViewerSends) {
  EXPECT_TRUE(is_sane(Pose{}));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity(), 1e10}) {
    Pose pose;
    pose.position.y = bad;
    EXPECT_FALSE(is_sane(pose)) << bad;
    pose = {};
    pose.orientation.z = bad;
    EXPECT_FALSE(is_sane(pose)) << bad;
    pose = {};
    pose.velocity.x = bad;
    EXPECT_FALSE(is_sane(pose)) << bad;
    pose = {};
    pose.angular_velocity.z = bad;
    EXPECT_FALSE(is_sane(pose)) << bad;
  }
  Pose pose;
  pose.orientation = glm::dquat(1.1, 0, 0, 0);
  EXPECT_FALSE(is_sane(pose));
  pose.orientation = glm::dquat(0, 0, 0, 0);
  EXPECT_FALSE(is_sane(pose));
  pose.orientation = glm::dquat(1.0005, 0, 0, 0);
  EXPECT_TRUE(is_sane(pose));
}

}  // namespace
}  // namespace atlaswire
