#include "base/program.h"
#include "server/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

namespace atlaswire::server {
namespace {

using ::testing::HasSubstr;

Options parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "atlasd");
  return parse_options(static_cast<int>(arguments.size()), arguments.data());
}

std::string refusal(const std::vector<const char*>& arguments) {
  try {
    parse(arguments);
  } catch (const ProgramError& e) {
    EXPECT_EQ(e.code(), ExitCode::kUsage);
    return e.what();
  }
  return "accepted";
}

TEST(Options, DefaultsServeTheAtriumOnLoopback) {
  const Options options = parse({});
  EXPECT_EQ(options.mode, Mode::kServe);
  EXPECT_EQ(options.settings.scene, "atrium");
  EXPECT_EQ(options.settings.listen, "127.0.0.1");
  EXPECT_EQ(options.settings.port, 7400);
  EXPECT_EQ(options.settings.stream.render.atlas, (Extent2D{1024, 1024}));
  EXPECT_EQ(options.settings.stream.video.intra_interval, 30U);
  EXPECT_FALSE(options.settings.stream.cover.fixed);
  EXPECT_FALSE(options.settings.mirror);
}

TEST(Options, MapEveryKindOfValue) {
  const auto s = parse({"--scene",
                        "a.glb",
                        "--atlas",
                        "2048x1024",
                        "--bitrate",
                        "2.5M",
                        "--fps",
                        "30",
                        "--cover",
                        "40",
                        "--mirror",
                        "[::1]:5004",
                        "--max-runtime",
                        "1.5",
                        "--port",
                        "0",
                        "--reshade-interval",
                        "4",
                        "--allocator",
                        "device",
                        "--level-hysteresis",
                        "0.5",
                        "--foveation",
                        "1.5",
                        "--priority",
                        "lamp=2",
                        "--priority",
                        "floor=-1",
                        "--layout-picture",
                        "l.png",
                        "--layout-colours",
                        "age",
                        "--log-level",
                        "debug"})
                     .settings;
  EXPECT_EQ(s.scene, "a.glb");
  EXPECT_EQ(s.stream.render.atlas, (Extent2D{2048, 1024}));
  EXPECT_EQ(s.stream.render.allocator.atlas, (Extent2D{2048, 1024}));
  EXPECT_EQ(s.stream.video.bit_rate.bits_per_second, 2'500'000U);
  EXPECT_EQ(s.stream.video.frame_rate, 30);
  EXPECT_EQ(s.stream.max_fps, 30);
  EXPECT_EQ(s.stream.cover.fixed, Duration{40ms});
  ASSERT_TRUE(s.mirror);
  EXPECT_EQ(s.mirror->host, "::1");
  EXPECT_EQ(s.mirror->port, 5004);
  EXPECT_EQ(s.max_runtime, Duration{1500ms});
  EXPECT_EQ(s.port, 0);
  EXPECT_EQ(s.stream.render.reshade_interval, 4U);
  EXPECT_EQ(s.stream.render.allocator_kind, render::AllocatorKind::kDevice);
  EXPECT_EQ(s.stream.render.level_hysteresis, 0.5);
  EXPECT_EQ(s.stream.render.emphasis,
            (Emphasis{.foveation = 1.5, .priorities = {{"lamp", 2}, {"floor", -1}}}));
  EXPECT_EQ(s.layout_picture, "l.png");
  EXPECT_EQ(s.stream.layout_colours, render::LayoutColours::kAge);
  EXPECT_EQ(s.log.level, spdlog::level::debug);
}

TEST(Options, RefusalsNameOptionValueAndCure) {
  EXPECT_THAT(refusal({"--atlas", "1000x1000"}), HasSubstr("--atlas 1000x1000: must be WxH"));
  EXPECT_THAT(refusal({"--bitrate", "fast"}), HasSubstr("--bitrate fast: must be"));
  EXPECT_THAT(refusal({"--cover", "-1"}), HasSubstr("--cover -1: must be auto or"));
  EXPECT_THAT(refusal({"--cover", "nan"}), HasSubstr("--cover nan"));
  EXPECT_THAT(refusal({"--fov-scale", "0.5"}), HasSubstr("--fov-scale 0.5: must be 1..2"));
  EXPECT_THAT(refusal({"--fov-scale", "nan"}), HasSubstr("--fov-scale nan"));
  EXPECT_THAT(refusal({"--allocator", "gpu"}), HasSubstr("auto, device or sequential"));
  EXPECT_THAT(refusal({"--foveation", "9"}), HasSubstr("--foveation 9: must be 0..8"));
  EXPECT_THAT(refusal({"--priority", "lamp"}), HasSubstr("--priority lamp: must be NAME=OCTAVES"));
  EXPECT_THAT(refusal({"--layout-colours", "red"}), HasSubstr("class, level or age"));
  EXPECT_THAT(refusal({"--method", "video"}), HasSubstr("--method video: must be sas"));
  EXPECT_THAT(refusal({"--port", "70000"}), HasSubstr("--port 70000: must be 0..65535"));
  EXPECT_THAT(refusal({"--grid-bits", "21"}), HasSubstr("--grid-bits 21: must be 8..20"));
  EXPECT_THAT(refusal({"--meta-codec", "zip"}),
              HasSubstr("--meta-codec zip: must be mirror, gate, plain or paper"));
  EXPECT_THAT(refusal({"--mirror", "localhost"}), HasSubstr("--mirror localhost: must be HOST:PORT"));
  EXPECT_THAT(refusal({"--mirror", "localhost:0"}), HasSubstr("--mirror"));
  EXPECT_THAT(refusal({"--encoder", "magic"}), HasSubstr("--encoder magic: must be one of auto"));
  EXPECT_THAT(refusal({"--preset", "placebo"}), HasSubstr("--preset placebo"));
  EXPECT_THAT(refusal({"--log-level", "loud"}), HasSubstr("--log-level loud"));
  EXPECT_THAT(refusal({"--max-sessions", "0"}), HasSubstr("--max-sessions 0: must be 1..1024"));
  EXPECT_THAT(refusal({"--port", "http"}), HasSubstr("--port"));
  EXPECT_THAT(refusal({"--frobnicate"}), HasSubstr("--frobnicate"));
}

TEST(Options, HelpAndVersionArePrinted) {
  const Options help = parse({"--help"});
  EXPECT_EQ(help.mode, Mode::kPrint);
  EXPECT_THAT(help.text, HasSubstr("--reshade-interval"));
  EXPECT_THAT(help.text, HasSubstr("Examples:"));
  EXPECT_THAT(parse({"--version"}).text, HasSubstr("atlasd "));
}

TEST(Options, ConfigFileSetsAndCommandLineWins) {
  const std::string file = ::testing::TempDir() + "atlasd_options_test.toml";
  std::ofstream(file) << "scene = \"town.glb\"\natlas = \"512x512\"\nvalidation = true\nfps = 20\n"
                      << "priority = [\"lamp=2\", \"floor=-1\"]\n";
  const auto s = parse({"--config", file.c_str(), "--fps", "25"}).settings;
  EXPECT_EQ(s.scene, "town.glb");
  EXPECT_EQ(s.stream.render.atlas, (Extent2D{512, 512}));
  EXPECT_TRUE(s.validation);
  EXPECT_EQ(s.stream.render.emphasis.priorities.size(), 2U);
  EXPECT_TRUE(parse({"--config", file.c_str()}).has_config);
  EXPECT_FALSE(parse({"--fps", "25"}).has_config);
  EXPECT_EQ(s.stream.max_fps, 25);
  std::ofstream(file) << "sceen = \"town.glb\"\n";
  EXPECT_THAT(refusal({"--config", file.c_str()}), HasSubstr("sceen"));
  std::remove(file.c_str());
  EXPECT_THAT(refusal({"--config", "/nonexistent/atlasd.toml"}), HasSubstr("/nonexistent/atlasd.toml"));
}

}  // namespace
}  // namespace atlaswire::server
