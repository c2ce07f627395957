#include "bench/motion_rival.h"
#include "bench/peer_motion.h"
#include "tests/bench/moving_recording.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace atlaswire::bench {
namespace {

struct Case {
  std::string name;
  std::function<std::unique_ptr<MotionRival>(const RecordedMotion&)> make;
};

class MotionRivals : public ::testing::TestWithParam<Case> {};

TEST_P(MotionRivals, ShowWhatWasTold) {
  const MetaRecording recording = moving_recording(12);
  MotionFollower follower(*recording.motion);
  const auto rival = GetParam().make(*recording.motion);
  for (const codec::MetaUpdate& update : recording.updates) {
    const MotionStep& step = follower.next(update);
    rival->encode(step);
    EXPECT_GT(rival->size(), 0U);
    rival->decode(update);
    EXPECT_NO_THROW(rival->check(step)) << "frame " << value(update.frame);
  }
}

TEST_P(MotionRivals, NoticeWhatWasNotHeard) {
  const MetaRecording recording = moving_recording(3);
  MotionFollower follower(*recording.motion);
  const auto rival = GetParam().make(*recording.motion);
  const MotionStep& first = follower.next(recording.updates[0]);
  rival->encode(first);
  rival->decode(recording.updates[0]);
  const MotionStep& second = follower.next(recording.updates[1]);
  rival->encode(second);
  EXPECT_THROW(rival->check(second), std::runtime_error);
}

INSTANTIATE_TEST_SUITE_P(
    All, MotionRivals,
    ::testing::Values(Case{"naive", [](const auto&) { return make_naive_motion(); }},
                      Case{"paper", [](const auto& motion) { return make_paper_motion(motion); }},
                      Case{"own", [](const auto& motion) { return make_own_motion(motion); }},
                      Case{"draco", [](const auto&) { return make_peer_motion(MotionPacking::kDraco, 2); }},
                      Case{"meshopt",
                           [](const auto&) { return make_peer_motion(MotionPacking::kMeshopt, 1); }},
                      Case{"zstd", [](const auto&) { return make_peer_motion(MotionPacking::kZstd, 0); }}),
    [](const auto& test) { return test.param.name; });

TEST(MotionFollower, HoldsStillWhatIsOutOfScope) {
  const MetaRecording recording = moving_recording(6);
  MotionFollower follower(*recording.motion);
  for (std::size_t i = 0; i < 4; ++i) follower.next(recording.updates[i]);
  const MotionStep before = follower.next(recording.updates[4]);
  const MotionStep& after = follower.next(recording.updates[5]);
  ASSERT_EQ(after.vertices.size(), 3U * 42);
  EXPECT_EQ(after.vertices[2], before.vertices[2]);  // gone since frame 4
  EXPECT_NE(after.vertices[3 * 41 + 2], before.vertices[3 * 41 + 2]);
  EXPECT_EQ(after.objects, before.objects);
}

TEST(MotionFollower, RefusesMotionOfOthers) {
  MetaRecording recording = moving_recording(2);
  recording.motion->frames[1].positions.pop_back();
  MotionFollower follower(*recording.motion);
  follower.next(recording.updates[0]);
  EXPECT_THROW(follower.next(recording.updates[1]), std::runtime_error);
}

}  // namespace
}  // namespace atlaswire::bench
