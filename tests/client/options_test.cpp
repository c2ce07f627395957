#include "base/program.h"
#include "client/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace atlaswire::client {
namespace {

using ::testing::HasSubstr;

Options parse(std::vector<const char*> words) {
  words.insert(words.begin(), "atlas-client");
  return parse_options(static_cast<int>(words.size()), words.data());
}

void expect_refused(const std::vector<const char*>& words, const std::string& what) {
  try {
    parse(words);
    FAIL() << "accepted " << words[0];
  } catch (const ProgramError& e) {
    EXPECT_EQ(e.code(), ExitCode::kUsage);
    EXPECT_THAT(e.what(), HasSubstr(what));
  }
}

TEST(ClientOptions, HaveWorkingDefaults) {
  const ClientSettings s = parse({}).settings;
  EXPECT_EQ(to_string(s.server), "127.0.0.1:7400");
  EXPECT_EQ(s.size, (Extent2D{960, 540}));
  EXPECT_NEAR(s.vertical_fov, 1.047198, 1e-6);
  EXPECT_EQ(s.duration, std::chrono::seconds(10));
  EXPECT_FALSE(s.wanted_atlas);
  EXPECT_FALSE(s.stereo);
  EXPECT_EQ(s.lens, render::LensCorrection{});
}

TEST(ClientOptions, EmphasisIsAWishOnlyWhereItIsSaid) {
  EXPECT_FALSE(parse({}).settings.emphasis);
  const ClientSettings s =
      parse({"--priority", "lamp=2", "--priority", "floor=-1", "--emphasis-after", "3"}).settings;
  EXPECT_EQ(s.emphasis, (Emphasis{.priorities = {{"lamp", 2}, {"floor", -1}}}));
  EXPECT_EQ(s.emphasis_after, std::chrono::seconds(3));
  EXPECT_EQ(parse({"--foveation", "0"}).settings.emphasis, Emphasis{.foveation = 0.0});
  expect_refused({"--foveation", "8.5"}, "--foveation 8.5: must be 0..8");
  expect_refused({"--priority", "lamp=9"}, "--priority lamp=9: must be NAME=OCTAVES");
}

TEST(ClientOptions, ReadEverythingFromTheCommandLine) {
  const ClientSettings s = parse({"--connect",
                                  "[::1]:99",
                                  "--size",
                                  "320x200",
                                  "--rate",
                                  "0",
                                  "--duration",
                                  "2.5",
                                  "--out",
                                  "o",
                                  "--png-every",
                                  "7",
                                  "--reference",
                                  "atrium",
                                  "--samples",
                                  "3",
                                  "--at-server-pose",
                                  "--bitrate",
                                  "2M",
                                  "--atlas",
                                  "512x512",
                                  "--server-fps",
                                  "20",
                                  "--json",
                                  "--fov",
                                  "90"})
                               .settings;
  EXPECT_EQ(to_string(s.server), "[::1]:99");
  EXPECT_EQ(s.size, (Extent2D{320, 200}));
  EXPECT_EQ(s.duration, std::chrono::milliseconds(2500));
  EXPECT_EQ(s.png_every, 7U);
  EXPECT_EQ(s.wanted_bit_rate, (BitRate{2'000'000}));
  EXPECT_EQ(s.wanted_atlas, (Extent2D{512, 512}));
  EXPECT_EQ(s.wanted_frame_rate, 20.0);
  EXPECT_NEAR(s.vertical_fov, 1.570796, 1e-6);
  EXPECT_TRUE(s.json && s.at_server_pose);
}

TEST(ClientOptions, ReadAConfigFile) {
  const auto file = std::filesystem::temp_directory_path() / "atlaswire_client_options_test.toml";
  std::ofstream(file) << "connect = \"far:7000\"\nsamples = 5\njson = true\n";
  const ClientSettings s = parse({"--config", file.c_str(), "--samples", "6"}).settings;
  EXPECT_EQ(s.server.host, "far");
  EXPECT_EQ(s.samples, 6U) << "the command line wins";
  EXPECT_TRUE(s.json);
  std::ofstream(file) << "conect = \"far:7000\"\n";
  expect_refused({"--config", file.c_str()}, "conect");
  std::filesystem::remove(file);
}

TEST(ClientOptions, ReadTheHeadset) {
  const ClientSettings s = parse({"--stereo", "--ipd", "0.07", "--lens", "generic"}).settings;
  EXPECT_TRUE(s.stereo);
  EXPECT_EQ(s.ipd, 0.07);
  EXPECT_EQ(s.lens, render::parse_lens("generic").value());
  EXPECT_EQ(parse({"--lens", "-0.1,0.2"}).settings.lens, render::parse_lens("-0.1,0.2").value());
  const auto file = std::filesystem::temp_directory_path() / "atlaswire_client_headset_test.toml";
  std::ofstream(file) << "stereo = true\nipd = 0.06\nlens = \"0.2,0.1\"\n";
  const ClientSettings from_file = parse({"--config", file.c_str()}).settings;
  EXPECT_TRUE(from_file.stereo);
  EXPECT_EQ(from_file.ipd, 0.06);
  EXPECT_EQ(from_file.lens, render::parse_lens("0.2,0.1").value());
  std::filesystem::remove(file);
}

TEST(ClientOptions, RefuseWhatCannotBe) {
  expect_refused({"--connect", "nowhere"}, "HOST:PORT");
  expect_refused({"--connect", "host:0"}, "HOST:PORT");
  expect_refused({"--connect", "host:70000"}, "HOST:PORT");
  expect_refused({"--size", "0x5"}, "--size 0x5");
  expect_refused({"--size", "wide"}, "--size wide");
  expect_refused({"--fov", "180"}, "10..170");
  expect_refused({"--rate", "nan"}, "--rate");
  expect_refused({"--stereo", "--ipd", "0"}, "--ipd");
  expect_refused({"--stereo", "--size", "9000x100"}, "8192");
  expect_refused({"--lens", "fisheye"}, "--lens fisheye: must be none, generic");
  expect_refused({"--duration", "-1"}, "--duration");
  expect_refused({"--warm-up", "20"}, "less than --duration");
  expect_refused({"--png-every", "3"}, "without --out");
  expect_refused({"--samples", "0"}, "--samples");
  expect_refused({"--bitrate", "fast"}, "--bitrate fast");
  expect_refused({"--log-level", "loud"}, "one of trace");
  expect_refused({"--frobnicate"}, "atlas-client --help");
}

TEST(ClientOptions, HelpShowsExamples) {
  const Options o = parse({"--help"});
  EXPECT_FALSE(o.run);
  EXPECT_THAT(o.text, HasSubstr("--at-server-pose"));
  EXPECT_THAT(o.text, HasSubstr("Examples:"));
}

}  // namespace
}  // namespace atlaswire::client
