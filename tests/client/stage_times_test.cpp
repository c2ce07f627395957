#include "client/stage_times.h"

#include "client/stage_log.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>
#include <string>

namespace atlaswire::client {
namespace {

Time at(int ms) { return Time{std::chrono::milliseconds(ms)}; }

/// [SAS] fig. 16 in whole milliseconds: 2, 4, 29, 30, 16, 2, 7.
PairTimes pair_of_the_paper() {
  return {.frame = FrameId{3},
          .pose = PoseId{9},
          .pose_sampled = at(0),
          .pose_received = at(2),
          .render_start = at(6),
          .encode_end = at(35),
          .video_arrival = at(65),
          .meta_arrival = at(54),
          .video_decoding = std::chrono::milliseconds(14),
          .meta_decoding = std::chrono::milliseconds(3),
          .ready = at(81)};
}

DrawTimes first_draw() {
  return {.first_start = at(83), .first_end = at(90), .start = at(83), .end = at(90)};
}

int ms(const StageDurations& d, Stage s) {
  return static_cast<int>(
      std::chrono::duration_cast<std::chrono::milliseconds>(d[static_cast<std::size_t>(s)]).count());
}

TEST(StageTimes, SplitTheRoundTripAsThePaperDoes) {
  const StageDurations d = stage_durations(pair_of_the_paper(), first_draw());
  EXPECT_EQ(ms(d, Stage::kClientToServer), 2);
  EXPECT_EQ(ms(d, Stage::kServerIdle), 4);
  EXPECT_EQ(ms(d, Stage::kServerProcessing), 29);
  EXPECT_EQ(ms(d, Stage::kServerToClient), 30);
  EXPECT_EQ(ms(d, Stage::kClientDecoding), 16);
  EXPECT_EQ(ms(d, Stage::kClientIdle), 2);
  EXPECT_EQ(ms(d, Stage::kClientRendering), 7);
  EXPECT_EQ(ms(d, Stage::kDisplayAge), 0);
  EXPECT_EQ(std::accumulate(d.begin(), d.end(), Duration{}),
            *pose_to_display(pair_of_the_paper(), first_draw()));
}

TEST(StageTimes, TransmissionEndsWithTheSlowerChannel) {
  PairTimes pair = pair_of_the_paper();
  pair.meta_arrival = at(75);
  const StageDurations d = stage_durations(pair, first_draw());
  EXPECT_EQ(ms(d, Stage::kServerToClient), 40);
  EXPECT_EQ(ms(d, Stage::kClientDecoding), 6);
}

TEST(StageTimes, DisplayAgeGrowsWithEveryUpsampledFrame) {
  DrawTimes later = first_draw();
  later.start = at(100);
  later.end = at(108);
  const StageDurations d = stage_durations(pair_of_the_paper(), later);
  EXPECT_EQ(ms(d, Stage::kDisplayAge), 18);
  EXPECT_EQ(ms(d, Stage::kClientRendering), 8);
  EXPECT_EQ(ms(d, Stage::kClientIdle), 2) << "waiting ended with the first drawing";
}

TEST(StageTimes, WithoutAPoseTheFirstTwoAreUnknown) {
  PairTimes pair = pair_of_the_paper();
  pair.pose_sampled.reset();
  const StageDurations d = stage_durations(pair, first_draw());
  EXPECT_EQ(ms(d, Stage::kClientToServer), 0);
  EXPECT_EQ(ms(d, Stage::kServerIdle), 0);
  EXPECT_FALSE(pose_to_display(pair, first_draw()));
}

TEST(StageLog, SummarizesPairsOnceAndDisplayedFramesEach) {
  StageLog log;
  log.add({pair_of_the_paper(), first_draw()});
  DrawTimes later = first_draw();
  later.start = at(100);
  later.end = at(111);
  log.add({pair_of_the_paper(), later});
  const auto stages = log.stages(at(0));
  EXPECT_EQ(stages[static_cast<std::size_t>(Stage::kServerProcessing)].count, 1U);
  EXPECT_EQ(stages[static_cast<std::size_t>(Stage::kClientRendering)].count, 2U);
  EXPECT_DOUBLE_EQ(stages[static_cast<std::size_t>(Stage::kClientRendering)].mean, 9.0);
  EXPECT_DOUBLE_EQ(stages[static_cast<std::size_t>(Stage::kDisplayAge)].largest, 21.0);
  EXPECT_DOUBLE_EQ(log.round_trip(at(0)).mean, 90.0);
  EXPECT_EQ(log.stages(at(90))[static_cast<std::size_t>(Stage::kServerProcessing)].count, 0U)
      << "warm-up is left out";
}

TEST(StageLog, WritesALineADisplayedFrame) {
  StageLog log;
  log.add({pair_of_the_paper(), first_draw()});
  const auto file = std::filesystem::temp_directory_path() / "atlaswire_stage_log_test.csv";
  ASSERT_TRUE(log.write_csv(file, at(80)));
  std::ifstream in(file);
  std::string header;
  std::string line;
  std::getline(in, header);
  std::getline(in, line);
  EXPECT_EQ(header,
            "display_start_ms,frame,pose,first,client_to_server_ms,server_idle_ms,server_processing_ms,"
            "server_to_client_ms,client_decoding_ms,client_idle_ms,client_rendering_ms,display_age_ms,"
            "video_decoding_ms,meta_decoding_ms,pose_to_display_ms");
  EXPECT_EQ(line, "3.000,3,9,1,2.000,4.000,29.000,30.000,16.000,2.000,7.000,0.000,14.000,3.000,90.000");
  std::filesystem::remove(file);
}

TEST(StageLog, NamesTheFileItCannotWrite) {
  const Result<void> r = StageLog{}.write_csv("no/such/folder/stages.csv", at(0));
  ASSERT_FALSE(r);
  EXPECT_NE(r.error().message().find("no/such/folder/stages.csv"), std::string::npos);
}

TEST(Distribution, UsesNearestRank) {
  Distribution d;
  for (int i = 100; i >= 1; --i) d.add(static_cast<double>(i));
  const Summary s = d.summary();
  EXPECT_DOUBLE_EQ(s.p50, 50);
  EXPECT_DOUBLE_EQ(s.p95, 95);
  EXPECT_DOUBLE_EQ(s.p99, 99);
  EXPECT_DOUBLE_EQ(s.mean, 50.5);
  EXPECT_DOUBLE_EQ(s.largest, 100);
  EXPECT_EQ(Distribution{}.summary().count, 0U);
}

}  // namespace
}  // namespace atlaswire::client
