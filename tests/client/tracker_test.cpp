#include "client/tracker.h"

#include "client/pose_history.h"

#include <gtest/gtest.h>

namespace atlaswire::client {
namespace {

using std::chrono::seconds;

Pose moving(Duration t) {
  Pose pose;
  pose.position = {to_seconds(t), 0, 0};
  pose.velocity = {1, 0, 0};
  return pose;
}

TEST(Tracker, KnowsNoPoseBeforeItsMotion) { EXPECT_FALSE(Tracker{}.at(Time{seconds(3)})); }

TEST(Tracker, HoldsStillUntilStarted) {
  Tracker tracker;
  tracker.set_motion(moving);
  const Pose still = tracker.at(Time{seconds(50)}).value();
  EXPECT_EQ(still.position.x, 0);
  EXPECT_EQ(still.velocity.x, 0) << "a server must not extrapolate what stands still";
  tracker.start(Time{seconds(60)});
  EXPECT_EQ(tracker.at(Time{seconds(62)})->position.x, 2);
  EXPECT_EQ(tracker.at(Time{seconds(62)})->velocity.x, 1);
  EXPECT_EQ(tracker.at(Time{seconds(59)})->position.x, 0) << "a sample from just before the start";
}

TEST(PoseHistory, FindsTheLastPosesByNumber) {
  PoseHistory history(4);
  EXPECT_FALSE(history.find(PoseId{0}));
  EXPECT_FALSE(history.find(PoseId{4}));
  for (std::uint32_t n = 1; n <= 6; ++n) history.add({.id = PoseId{n}, .sampled = Time{seconds(n)}});
  EXPECT_FALSE(history.find(PoseId{2})) << "overwritten";
  EXPECT_EQ(history.find(PoseId{3})->sampled, Time{seconds(3)});
  EXPECT_EQ(history.find(PoseId{6})->sampled, Time{seconds(6)});
  EXPECT_FALSE(history.find(PoseId{7}));
}

}  // namespace
}  // namespace atlaswire::client
