#include "render/scene/keyframes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace atlaswire::render {
namespace {

using Interpolation = RigChannel::Interpolation;
using Path = RigChannel::Path;

std::array<double, 3> at(const RigChannel& channel, double seconds) {
  std::array<double, 3> out{};
  sample(channel, seconds, out);
  return out;
}

RigChannel two_keys(Interpolation interpolation) {
  RigChannel channel;
  channel.interpolation = interpolation;
  channel.times = {1, 3};
  channel.values = {0, 10, -1, 4, 20, -1};
  return channel;
}

TEST(Keyframes, LinearGoesEvenlyAndStaysAtTheEnds) {
  const RigChannel channel = two_keys(Interpolation::kLinear);
  EXPECT_EQ(at(channel, 0), (std::array<double, 3>{0, 10, -1}));
  EXPECT_EQ(at(channel, 1), (std::array<double, 3>{0, 10, -1}));
  EXPECT_EQ(at(channel, 1.5), (std::array<double, 3>{1, 12.5, -1}));
  EXPECT_EQ(at(channel, 3), (std::array<double, 3>{4, 20, -1}));
  EXPECT_EQ(at(channel, 99), (std::array<double, 3>{4, 20, -1}));
}

TEST(Keyframes, StepStaysUntilTheNextKey) {
  const RigChannel channel = two_keys(Interpolation::kStep);
  EXPECT_EQ(at(channel, 2.99), (std::array<double, 3>{0, 10, -1}));
  EXPECT_EQ(at(channel, 3), (std::array<double, 3>{4, 20, -1}));
}

TEST(Keyframes, CubicSplineIsTheHermiteOfScaledTangents) {
  RigChannel channel;
  channel.interpolation = Interpolation::kCubicSpline;
  channel.times = {0, 2};
  // In-tangent, value, out-tangent: the first key's in and the last one's out do not count.
  channel.values = {9, 9, 9, 0, 0, 1, 3, 0, 0, /**/ 0, 6, 0, 1, 2, 1, 9, 9, 9};
  const auto middle = at(channel, 1);
  // h00 = h01 = 1/2, h10 = 1/8, h11 = -1/8, tangents times 2 s.
  EXPECT_DOUBLE_EQ(middle[0], 0.5 * 1 + 0.125 * 2 * 3);
  EXPECT_DOUBLE_EQ(middle[1], 0.5 * 2 - 0.125 * 2 * 6);
  EXPECT_DOUBLE_EQ(middle[2], 1);
  EXPECT_EQ(at(channel, 2)[1], 2);
  EXPECT_EQ(at(channel, -1)[2], 1);
}

TEST(Keyframes, RotationsGoTheShorterWayAtEvenSpeed) {
  RigChannel channel;
  channel.path = Path::kRotation;
  channel.width = 4;
  channel.times = {0, 1};
  const float half = std::sqrt(0.5F);
  channel.values = {0, 0, 0, 1, 0, -half, 0, -half};  // a quarter about +y, written the other way round
  std::array<double, 4> q{};
  sample(channel, 1.0 / 3, q);
  EXPECT_NEAR(std::abs(q[1]), std::sin(M_PI / 12), 1e-7);
  EXPECT_NEAR(q[1] * q[3], std::sin(M_PI / 12) * std::cos(M_PI / 12), 1e-7);
}

TEST(Keyframes, RotationsComeOutUnit) {
  RigChannel channel;
  channel.path = Path::kRotation;
  channel.interpolation = Interpolation::kCubicSpline;
  channel.width = 4;
  channel.times = {0, 1};
  channel.values = {0, 0, 0, 0, 0, 0, 0, 2, 1, 0, 0, 0, /**/ 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  std::array<double, 4> q{};
  for (const double t : {0.0, 0.3, 1.0}) {
    sample(channel, t, q);
    EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-12) << t;
  }
  EXPECT_EQ(q[3], 1) << "nothing turns into no rotation";
}

}  // namespace
}  // namespace atlaswire::render
