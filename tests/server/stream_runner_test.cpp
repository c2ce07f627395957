#include "server/stream_runner.h"

#include "tests/server/fake_stream.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <vector>

namespace atlaswire::server {
namespace {

/// A runner over a fake stream; collects what it says.
class StreamRunnerTest : public ::testing::Test {
 protected:
  StreamRunnerTest() {
    settings.max_fps = 240;
    settings.cover.fixed = Duration{0};
  }

  void start() {
    StreamRunner::Callbacks callbacks;
    callbacks.make = [this] { return source.make(); };
    callbacks.give_back = [this](std::unique_ptr<FrameMaker> maker) { source.give_back(std::move(maker)); };
    callbacks.on_frame = [this](FramePtr frame) {
      {
        const std::lock_guard lock(mutex);
        frames.push_back(std::move(frame));
      }
      changed.notify_all();
      if (take) taker->frame_taken();
    };
    callbacks.on_failure = [this](std::string reason) {
      {
        const std::lock_guard lock(mutex);
        failures.push_back(std::move(reason));
      }
      changed.notify_all();
    };
    runner = std::make_unique<StreamRunner>(settings, std::move(callbacks));
    taker = runner.get();
  }

  void pose(std::uint32_t id) { runner->set_view({PoseId{id}, {}, {}}, steady_now(), Duration{0}); }

  template <class Done>
  bool wait(Done done) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, std::chrono::seconds(20), done);
  }

  FakeSource source;
  StreamRunner::Settings settings;
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<FramePtr> frames;
  std::vector<std::string> failures;
  bool take = true;
  std::unique_ptr<StreamRunner> runner;
  StreamRunner* taker = nullptr;  ///< for its own threads, which see it after the first pose
};

TEST_F(StreamRunnerTest, RendersNothingWithoutAPoseAndGivesTheStreamBack) {
  start();
  runner.reset();
  EXPECT_EQ(source.watch.rendered, 0U);
  EXPECT_EQ(source.given_back, 1U);
}

TEST_F(StreamRunnerTest, PipelinesFramesInOrderForTheNewestPose) {
  start();
  pose(3);
  ASSERT_TRUE(wait([&] { return frames.size() >= 30; }));
  pose(4);
  ASSERT_TRUE(wait([&] { return frames.back()->pose == PoseId{4}; }));
  runner.reset();
  EXPECT_FALSE(source.watch.order_broken);
  EXPECT_EQ(source.watch.rendered, source.watch.encoded) << "every rendered frame is encoded, the last too";
  EXPECT_TRUE(frames[0]->idr);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(value(frames[i]->frame), i);
    const auto& s = frames[i]->stamps;
    EXPECT_LE(s.pose_received, s.render_start);
    EXPECT_LE(s.render_start, s.render_end);
    EXPECT_LE(s.render_end, s.encode_end);
  }
}

TEST_F(StreamRunnerTest, StopsAheadOfAReaderThatTakesNothing) {
  take = false;
  start();
  pose(1);
  ASSERT_TRUE(wait([&] { return frames.size() >= 2; }));
  runner.reset();
  EXPECT_LE(frames.size(), 4U) << "two untaken, two in work";
}

TEST_F(StreamRunnerTest, HoldsThePace) {
  settings.max_fps = 50;
  start();
  const Time begun = steady_now();
  pose(1);
  ASSERT_TRUE(wait([&] { return frames.size() >= 11; }));
  EXPECT_GE(steady_now() - begun, Duration{std::chrono::milliseconds(195)}) << "ten intervals of 20 ms";
}

TEST_F(StreamRunnerTest, PausesAndResumes) {
  start();
  runner->set_paused(true);
  pose(1);
  runner->set_paused(false);
  EXPECT_TRUE(wait([&] { return !frames.empty(); }));
}

TEST_F(StreamRunnerTest, RefreshReachesTheStream) {
  start();
  pose(1);
  ASSERT_TRUE(wait([&] { return frames.size() >= 3; }));
  const std::uint32_t before = source.watch.intra;
  const auto rendered = source.watch.rendered.load();
  runner->request_refresh();
  ASSERT_TRUE(wait([&] { return source.watch.rendered > rendered + 2; }));
  EXPECT_GT(source.watch.intra, before);
}

TEST_F(StreamRunnerTest, ScenesMoveFromTheFirstFrameOnForThoseWhoShowIt) {
  start();
  pose(1);
  ASSERT_TRUE(wait([&] { return frames.size() >= 3; }));
  EXPECT_EQ(source.watch.scene_seconds, -1);
  runner.reset();
  frames.clear();
  settings.shows_motion = true;
  start();
  pose(1);
  ASSERT_TRUE(wait([&] { return !frames.empty(); }));
  const double early = source.watch.scene_seconds;
  EXPECT_GE(early, 0);
  const auto rendered = source.watch.rendered.load();
  ASSERT_TRUE(wait([&] { return source.watch.rendered > rendered + 2; }));
  EXPECT_GT(source.watch.scene_seconds, early);
}

TEST_F(StreamRunnerTest, ForeseenMotionIsAheadByWhatFramesTake) {
  settings.shows_motion = true;
  settings.foresee_motion = true;
  settings.cover.fixed = std::chrono::hours(1);
  start();
  pose(1);
  ASSERT_TRUE(wait([&] { return !frames.empty(); }));
  EXPECT_NEAR(source.watch.scene_seconds, 3600, 60);
}

TEST_F(StreamRunnerTest, RestartReachesTheStreamOnce) {
  start();
  pose(1);
  ASSERT_TRUE(wait([&] { return frames.size() >= 3; }));
  EXPECT_EQ(source.watch.restarts, 1U) << "the first frame";
  runner->request_restart();
  const auto rendered = source.watch.rendered.load();
  ASSERT_TRUE(wait([&] { return source.watch.rendered > rendered + 3; }));
  EXPECT_EQ(source.watch.restarts, 2U);
}

TEST_F(StreamRunnerTest, AFailedDeviceEndsTheStreamOnce) {
  source.watch.fail_render_at = 3;
  start();
  pose(1);
  ASSERT_TRUE(wait([&] { return !failures.empty(); }));
  runner.reset();
  ASSERT_EQ(failures.size(), 1U);
  EXPECT_EQ(failures[0], "rendering failed: device lost");
  EXPECT_EQ(frames.size(), 3U);
  EXPECT_EQ(source.given_back, 0U) << "a broken stream is not used again";
}

TEST_F(StreamRunnerTest, AFailedEncoderEndsTheStreamOnce) {
  source.watch.fail_encode_at = 2;
  start();
  pose(1);
  ASSERT_TRUE(wait([&] { return !failures.empty(); }));
  runner.reset();
  ASSERT_EQ(failures.size(), 1U);
  EXPECT_EQ(frames.size(), 2U);
  EXPECT_EQ(source.given_back, 0U);
}

TEST_F(StreamRunnerTest, AStreamThatCannotBeMadeIsAFailure) {
  source.fail_to_make = true;
  start();
  ASSERT_TRUE(wait([&] { return !failures.empty(); }));
  EXPECT_EQ(failures[0], "rendering failed: no memory on the device");
}

}  // namespace
}  // namespace atlaswire::server
