#include "lab/live_run.h"

#include "lab/lab_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace atlaswire::lab {
namespace {

using testing::Contains;
using testing::IsSupersetOf;
using testing::Not;

TEST(LiveRun, SettingsBecomeOptions) {
  PointSettings s;
  s.profile = "wifi6";
  s.bitrate_mbps = 10;
  s.display = {200, 100};
  s.horizontal_fov = 90;
  const auto c = live_commands(s, "/bin", "/out");
  ASSERT_TRUE(c.has_value()) << c.error().message();
  EXPECT_THAT(c->daemon, IsSupersetOf({"/bin/atlasd", "--bitrate", "10000000", "--atlas", "2048x2048"}));
  EXPECT_THAT(c->relay, IsSupersetOf({"/bin/atlas-netsim", "--profile", "wifi6"}));
  EXPECT_THAT(c->client, IsSupersetOf({"/bin/atlas-client", "--size", "200x100", "--fov", "53.130102"}));
  EXPECT_THAT(c->client, Not(Contains("--stereo")));
  s.stereo = true;
  s.ipd = 0.07;
  s.lens = "generic";
  EXPECT_THAT(live_commands(s, "/bin", "/out")->client,
              IsSupersetOf({"--stereo", "--ipd", "0.07", "--lens", "generic"}));
  s.profile.clear();
  EXPECT_TRUE(live_commands(s, "/bin", "/out")->relay.empty());
}

TEST(LiveRun, RefusesWhatItCannotHonour) {
  PointSettings s;
  s.latency_ms = 50;
  EXPECT_EQ(live_commands(s, "/bin", "/out").error().code, LabError::kOutOfRange);
  s = {};
  s.method = "atw";
  EXPECT_TRUE(live_commands(s, "/bin", "/out").has_error());
  s = {};
  s.foresight = true;
  EXPECT_TRUE(live_commands(s, "/bin", "/out").has_error());
}

TEST(LiveRun, ReadsTheClientsSummary) {
  const auto t =
      live_timings(R"({"stages_ms": {"client_to_server": 1, "server_idle": 2, "server_processing": 3,
    "server_to_client": 4, "client_decoding": 5, "client_idle": 6, "client_rendering": 7, "display_age": 8},
    "latency_ms": {"pose_to_display": {"mean": 28}}, "server": {"fps": 30}, "client": {"fps": 60}, "video": {"mbps": 9},
    "meta": {"mbps": 1}, "mssim": 0.9, "mssim_lowest": 0.8, "psnr": 30, "coverage": 0.99, "frames": {"lost": 0}})");
  ASSERT_TRUE(t.has_value()) << t.error().message();
  EXPECT_EQ(t->at(2).name, "server_processing");
  EXPECT_EQ(t->at(2).value, 3);
  EXPECT_TRUE(live_timings("").has_error());
  EXPECT_TRUE(live_timings("{}").has_error());
}

}  // namespace
}  // namespace atlaswire::lab
