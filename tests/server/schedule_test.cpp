#include "server/client_camera.h"
#include "server/cover_estimator.h"
#include "server/intra_schedule.h"
#include "server/rate_fitter.h"

#include <gtest/gtest.h>

#include <string>

namespace atlaswire::server {
namespace {

/// 'I' and 'P' of the next `frames` frames.
std::string frames_of(IntraSchedule& schedule, int frames) {
  std::string out;
  for (int i = 0; i < frames; ++i) out += schedule.next() ? 'I' : 'P';
  return out;
}

TEST(IntraSchedule, RepeatsEveryInterval) {
  IntraSchedule schedule({.interval = 5});
  EXPECT_EQ(frames_of(schedule, 12), "IPPPPIPPPPIP");
}

TEST(IntraSchedule, IntervalZeroMakesOnlyTheFirst) {
  IntraSchedule schedule({.interval = 0});
  EXPECT_EQ(frames_of(schedule, 8), "IPPPPPPP");
}

TEST(IntraSchedule, ALossRestartsTheInterval) {
  IntraSchedule schedule({.interval = 5});
  EXPECT_EQ(frames_of(schedule, 3), "IPP");
  schedule.ask_for_loss();
  EXPECT_EQ(frames_of(schedule, 6), "IPPPPI");
}

TEST(IntraSchedule, ManyLossesCannotMakeEveryFrameIntra) {
  IntraSchedule schedule({.interval = 0, .loss_spacing = 3});
  std::string out;
  for (int i = 0; i < 9; ++i) {
    schedule.ask_for_loss();
    out += schedule.next() ? 'I' : 'P';
  }
  EXPECT_EQ(out, "IPPIPPIPP");
}

TEST(IntraSchedule, MemoryWaitsLonger) {
  IntraSchedule schedule({.interval = 0, .loss_spacing = 1, .memory_spacing = 4});
  EXPECT_EQ(frames_of(schedule, 2), "IP");
  schedule.ask_for_memory();
  EXPECT_EQ(frames_of(schedule, 4), "PPIP");
}

TEST(IntraSchedule, ANewcomerNeverWaits) {
  IntraSchedule schedule({.interval = 0});
  EXPECT_EQ(frames_of(schedule, 1), "I");
  schedule.ask_at_once();
  EXPECT_EQ(frames_of(schedule, 2), "IP");
}

TEST(CoverEstimator, SumsWhatIsMeasured) {
  CoverEstimator cover({.fixed = {}, .allowance = 10ms, .most = 500ms}, 50ms);
  EXPECT_EQ(cover.cover(), Duration{60ms}) << "nothing measured yet";
  cover.on_round_trip(30ms);
  for (int i = 0; i < 200; ++i) cover.on_frame(80ms, 100ms);
  EXPECT_NEAR(to_ms(cover.cover()), 30 + 80 + 100 + 10, 0.1);
}

TEST(CoverEstimator, OneSlowFrameCountsAnEighth) {
  CoverEstimator cover({.fixed = {}, .allowance = 0ms, .most = 500ms}, 50ms);
  for (int i = 0; i < 10; ++i) cover.on_frame(40ms, 50ms);
  cover.on_frame(120ms, 50ms);
  EXPECT_NEAR(to_ms(cover.cover()), 50 + 40 + 10, 0.1);
}

TEST(CoverEstimator, StaysWithinItsBounds) {
  CoverEstimator cover({.fixed = {}, .allowance = 10ms, .most = 500ms}, 50ms);
  cover.on_round_trip(from_seconds(60));
  EXPECT_EQ(cover.cover(), Duration{500ms});
  CoverEstimator fixed({.fixed = Duration{25ms}, .allowance = 10ms, .most = 500ms}, 50ms);
  fixed.on_round_trip(from_seconds(60));
  EXPECT_EQ(fixed.cover(), Duration{25ms});
}

TEST(CoverEstimator, AFrameIsDisplayedInTheMiddleOfWhatItCovers) {
  CoverEstimator cover({.fixed = {}, .allowance = 10ms, .most = 500ms}, 50ms);
  cover.on_round_trip(30ms);
  for (int i = 0; i < 200; ++i) cover.on_frame(80ms, 100ms);
  // 15 ms back to the client, 80 - 20 ms of work after the pose's wait, 10 ms allowed, half of 100 ms on
  // display.
  EXPECT_NEAR(to_ms(cover.display_delay(20ms)), 15 + 60 + 10 + 50, 0.1);
  EXPECT_EQ(cover.display_delay(from_seconds(5)), Duration::zero());
}

TEST(CoverEstimator, PacingCountsToo) {
  CoverEstimator cover({.fixed = {}, .allowance = 0ms, .most = 500ms}, 50ms);
  for (int i = 0; i < 200; ++i) cover.on_sending(24ms);
  EXPECT_NEAR(to_ms(cover.cover()), 50 + 24, 0.1);
}

/// The rate told after `count` intervals, 0 when none is.
std::uint64_t told_after(RateFitter& fitter, int count, Duration interval) {
  for (int i = 0; i < count; ++i) fitter.on_interval(interval);
  const auto rate = fitter.take();
  return rate ? rate->bits_per_second : 0;
}

TEST(RateFitter, TellsTheTargetOnceWhileFramesComeInTime) {
  RateFitter fitter(BitRate{10'000'000}, 20);
  EXPECT_EQ(told_after(fitter, 0, {}), 10'000'000U);
  EXPECT_EQ(told_after(fitter, 50, 50ms), 0U);
  EXPECT_EQ(told_after(fitter, 50, 55ms), 0U) << "within the dead band";
}

TEST(RateFitter, SlowFramesGetTheirShareOfTime) {
  RateFitter fitter(BitRate{10'000'000}, 20);
  fitter.take();
  EXPECT_NEAR(static_cast<double>(told_after(fitter, 200, 150ms)), 30e6, 1e5);
  EXPECT_NEAR(static_cast<double>(told_after(fitter, 200, 50ms)), 10e6, 1e5);
}

TEST(RateFitter, NeverMoreThanEightSharesAndNeverBelowTheTarget) {
  RateFitter fitter(BitRate{1'000'000}, 100);
  fitter.take();
  EXPECT_EQ(told_after(fitter, 200, from_seconds(100)), 8'000'000U);
  EXPECT_EQ(told_after(fitter, 200, 1ms), 1'000'000U);
}

TEST(RateFitter, LeavesConstantQualityAlone) {
  RateFitter fitter(std::nullopt, 20);
  EXPECT_EQ(told_after(fitter, 200, 500ms), 0U);
}

TEST(ClientCamera, KeepsAspectAndBoundsSides) {
  EXPECT_EQ(client_camera({960, 540}, 1.0, 0.1).extent, (Extent2D{960, 540}));
  EXPECT_EQ(client_camera({16384, 8192}, 1.0, 0.1).extent, (Extent2D{4096, 2048}));
  EXPECT_EQ(client_camera({16384, 1}, 1.0, 0.1).extent, (Extent2D{4096, 1}));
  EXPECT_EQ(client_camera({960, 540}, 1.25, 0.1).vertical_fov, 1.25);
}

}  // namespace
}  // namespace atlaswire::server
