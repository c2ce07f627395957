#include "client/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace atlaswire::client {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

RunReport some_report() {
  RunReport r;
  r.scene = "atrium";
  r.device = "llvmpipe";
  r.server_fps = 12.5;
  r.client_fps = 30;
  r.video_mbps = 8;
  r.meta_mbps = 0.5;
  r.frames_paired = 100;
  r.frames_lost = 2;
  r.frames_decoded = 101;
  r.stages[static_cast<std::size_t>(Stage::kServerProcessing)] = {
      .count = 10, .mean = 29, .p50 = 28, .p95 = 40, .p99 = 41};
  r.quality = QualitySummary{.count = 3, .mssim = 0.95, .mssim_lowest = 0.9, .psnr = 31, .coverage = 0.999};
  r.files = {"out/summary.json"};
  return r;
}

TEST(Report, JsonHasWhatScriptsRelyOn) {
  const nlohmann::json j = nlohmann::json::parse(to_json(some_report()));
  EXPECT_EQ(j["server"]["fps"], 12.5);
  EXPECT_EQ(j["client"]["fps"], 30);
  EXPECT_EQ(j["video"]["mbps"], 8);
  EXPECT_EQ(j["meta"]["mbps"], 0.5);
  EXPECT_EQ(j["mssim"], 0.95);
  EXPECT_EQ(j["psnr"], 31);
  EXPECT_EQ(j["coverage"], 0.999);
  EXPECT_EQ(j["frames"]["paired"], 100);
  EXPECT_EQ(j["frames"]["lost"], 2);
  EXPECT_EQ(j["frames"]["decoded"], 101);
  for (const char* stage : {"client_to_server", "server_idle", "server_processing", "server_to_client",
                            "client_decoding", "client_idle", "client_rendering", "display_age"}) {
    EXPECT_TRUE(j["stages_ms"][stage].is_number()) << stage;
    EXPECT_TRUE(j["stages_percentiles_ms"][stage]["p95"].is_number()) << stage;
  }
  EXPECT_EQ(j["stages_ms"]["server_processing"], 29);
  EXPECT_EQ(j["stages_percentiles_ms"]["server_processing"]["p95"], 40);
  EXPECT_TRUE(j["latency_ms"]["pose_to_display"]["p50"].is_number());
  EXPECT_TRUE(j["bytes"]["video"].is_number());
  EXPECT_EQ(j["settings"]["connect"], "127.0.0.1:7400");
  EXPECT_EQ(j["end"], "finished");
}

TEST(Report, WithoutAReferenceThereIsNoQuality) {
  RunReport r = some_report();
  r.quality.reset();
  EXPECT_FALSE(nlohmann::json::parse(to_json(r)).contains("mssim"));
  EXPECT_THAT(to_table(r), Not(HasSubstr("MSSIM")));
}

TEST(Report, TableNamesStagesQualityAndFiles) {
  const std::string table = to_table(some_report());
  for (const char* words : {"server 12.5", "displayed 30.0", "server_processing", "29.00", "MSSIM", "0.9500",
                            "99.900 %", "out/summary.json"}) {
    EXPECT_THAT(table, HasSubstr(words));
  }
}

}  // namespace
}  // namespace atlaswire::client
