#include "base/host_port.h"
#include "base/option_check.h"
#include "base/program.h"
#include "base/version.h"
#include "client/settings.h"
#include "proto/plain_text.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <numbers>

namespace atlaswire::client {
namespace {

constexpr const char* kFooter = R"(Examples:
  atlas-client --connect 127.0.0.1:7400
      ten seconds of the scene's own camera path; a table of rates and latencies at the end
  atlas-client --connect host:7400 --out run --reference atrium --png-every 30
      also compares with ground truth rendered here, and writes pictures, stages.csv and summary.json
  atlas-client --connect host:7400 --rate 0 --size 1920x1080 --duration 30
      as many frames a second as this machine can draw
  atlas-client --connect host:7400 --reference town.glb --at-server-pose
      quality with no latency at all: each sampled pair drawn at the pose it was shaded for
  atlas-client --connect host:7400 --stereo --lens generic --size 960x1080 --fov 90 --out run --png-every 60
      what a headset shows: both eyes side by side, corrected for its lenses
  atlas-client --config client.toml           options as TOML keys without dashes: connect = "host:7400"

Exit codes: 0 done, 2 usage, 3 bad path or scene, 4 no Vulkan device, 6 cannot connect, 7 refused,
8 server lost (what came is still written), 9 cannot write --out, 130 interrupted before the first frame.
SIGINT and SIGTERM end the run early and orderly.)";

/// The texts and numbers that become other types after parsing.
struct Raw {
  std::string connect = "127.0.0.1:7400";
  std::string size = "960x540";
  std::string out;
  std::string wanted_atlas;
  std::string wanted_bit_rate;
  std::string log_level = "info";
  std::string lens = "none";
  double wanted_frame_rate = 0;
  std::optional<double> foveation;
  std::vector<std::string> priorities;
  double emphasis_after_s = 0;
  double wait_s = 5;
  double fov_degrees = 60;
  double duration_s = 10;
  double warm_up_s = 1;
};

void add_connection_options(CLI::App& app, Raw& raw) {
  auto* group = app.add_option_group("Connection");
  group->add_option("--connect", raw.connect, "HOST:PORT of an atlasd; TCP and UDP go to the same port");
  group->add_option("--wait", raw.wait_s, "Seconds to keep trying while nobody listens there, 0..3600");
  group->add_option("--atlas", raw.wanted_atlas,
                    "Wish for an atlas of WxH texels; today's atlasd ignores it");
  group->add_option("--bitrate", raw.wanted_bit_rate, "Wish for a video rate such as 10M");
  group->add_option("--server-fps", raw.wanted_frame_rate,
                    "Wish for this many server frames a second, 1..240");
  group->add_option(
      "--foveation", raw.foveation,
      "Octaves of atlas area that surfaces lose per radian away from the view axis, 0..8, whatever "
      "the server has: a sharper centre against the rim");
  group->add_option("--priority", raw.priorities,
                    "NAME=OCTAVES, once for each: atlas area of a material or object of the scene, -8..8");
  group->add_option("--emphasis-after", raw.emphasis_after_s,
                    "Seconds from the server's answer until it is told these two, 0..1000000");
}

void add_view_options(CLI::App& app, ClientSettings& s, Raw& raw) {
  auto* group = app.add_option_group("View");
  group->add_option("--path", s.path,
                    "Camera path: CSV file t,px,py,pz,qx,qy,qz,qw or a built-in name; empty: the one of the "
                    "server's scene");
  group->add_option("--size", raw.size,
                    "Display WxH in pixels, 16x16..16384x16384: detail against drawing time");
  group->add_option("--fov", raw.fov_degrees, "Vertical field of view in degrees, 10..170");
  group->add_flag("--stereo", s.stereo,
                  "Draw twice, once an eye, side by side; --size is one eye's, and the server covers both");
  group->add_option("--ipd", s.ipd, "Metres between the eyes with --stereo, 0.001..1");
  group->add_option(
      "--lens", raw.lens,
      "Correct what is displayed for a headset's lens: none, generic, K1,K2, or K1,K2 of red, green "
      "and blue in turn, each -10..10; what shows r half heights from the centre comes from "
      "r (1 + K1 r^2 + K2 r^4)");
  group->add_option("--rate", s.rate, "Displayed frames a second, 0..1000; 0: as many as can be drawn");
  group->add_option("--pose-rate", s.pose_rate,
                    "Poses sent a second, 1..1000: less waiting at the server against uplink packets");
  group->add_option("--duration", raw.duration_s,
                    "Seconds to run from the first displayed frame, 0..1000000; 0: until interrupted");
  group->add_option("--warm-up", raw.warm_up_s, "First seconds of it that no statistics count, 0..3600");
  group->add_option("--device", s.device,
                    "auto, an index, or part of a Vulkan device's name; llvmpipe is the CPU");
  group->add_flag("--validation", s.validation, "Vulkan validation layer: finds faults, slows start-up");
  group->add_option("--decoder-threads", s.decoder_threads, "Slices decoded side by side, 1..16");
}

void add_output_options(CLI::App& app, ClientSettings& s, Raw& raw) {
  auto* group = app.add_option_group("Output");
  group->add_option("--out", raw.out, "Folder for summary.json, stages.csv and pictures; made if missing");
  group->add_option("--png-every", s.png_every, "Write every N-th displayed frame as PNG; 0: none");
  group->add_option("--reference", s.reference,
                    "Scene (name or .glb) to render ground truth from, for MSSIM, PSNR and coverage");
  group->add_option("--samples", s.samples,
                    "Displayed frames that are compared with it, 1..1000, evenly spread");
  group->add_flag("--at-server-pose", s.at_server_pose,
                  "Compare each sampled pair at the pose the server rendered it for: no latency to hide");
  group->add_flag("--json", s.json, "Print the summary as JSON on stdout instead of the table");
  group->add_flag("--quiet", s.quiet, "No table and no progress; warnings and errors only");
  group->add_flag("--verbose", s.verbose, "Progress each second even where stderr is no terminal");
  group->add_option("--log-level", raw.log_level, "trace, debug, info, warn, error or off");
  group->add_flag("--json-logs", s.log.json, "Log one JSON object a line on stderr");
}

HostPort parse_server(const std::string& text) {
  auto server = parse_host_port(text);
  if (!server || server->port == 0)
    refuse_option("--connect", text, "HOST:PORT or [IPV6]:PORT, port 1..65535");
  return *std::move(server);
}

Duration parse_seconds(const char* option, double seconds, double high) {
  demand_range(option, seconds, 0.0, high, " seconds");
  return from_seconds(seconds);
}

void apply_wishes(const Raw& raw, ClientSettings& s) {
  if (!raw.wanted_atlas.empty()) {
    const auto atlas = parse_extent(raw.wanted_atlas);
    const auto fits = [](std::uint32_t side) { return side >= 64 && side <= 16'384; };
    if (!atlas || !fits(atlas->width) || !fits(atlas->height)) {
      refuse_option("--atlas", raw.wanted_atlas, "WxH, sides 64..16384");
    }
    s.wanted_atlas = *atlas;
  }
  if (!raw.wanted_bit_rate.empty()) {
    const auto rate = parse_bit_rate(raw.wanted_bit_rate);
    if (!rate || rate->bits_per_second < 1000 || rate->bits_per_second > 10'000'000'000) {
      refuse_option("--bitrate", raw.wanted_bit_rate, "a rate such as 800k or 10M, 1k..10G");
    }
    s.wanted_bit_rate = *rate;
  }
  if (raw.wanted_frame_rate != 0) {
    demand_range("--server-fps", raw.wanted_frame_rate, 1.0, 240.0);
    s.wanted_frame_rate = raw.wanted_frame_rate;
  }
}

void apply_emphasis(const Raw& raw, ClientSettings& s) {
  if (!raw.foveation && raw.priorities.empty()) return;
  Emphasis& emphasis = s.emphasis.emplace();
  if (raw.foveation) demand_range("--foveation", *raw.foveation, 0.0, Emphasis::kMostFoveation);
  emphasis.foveation = raw.foveation;
  if (raw.priorities.size() > Emphasis::kMostPriorities) {
    refuse_option("--priority", raw.priorities.back(), "one of at most 256");
  }
  for (const std::string& text : raw.priorities) {
    auto priority = parse_surface_priority(text);
    if (!priority || !proto::is_plain_text(priority->name)) {
      refuse_option("--priority", text, "NAME=OCTAVES, -8..8");
    }
    emphasis.priorities.push_back(*std::move(priority));
  }
  s.emphasis_after = parse_seconds("--emphasis-after", raw.emphasis_after_s, 1e6);
}

void apply_view(const Raw& raw, ClientSettings& s) {
  const auto size = parse_extent(raw.size);
  const auto fits = [](std::uint32_t side) { return side >= 16 && side <= 16'384; };
  if (!size || !fits(size->width) || !fits(size->height))
    refuse_option("--size", raw.size, "WxH, sides 16..16384");
  if (s.stereo && size->width > 8192) refuse_option("--size", raw.size, "at most 8192 wide with --stereo");
  s.size = *size;
  demand_range("--fov", raw.fov_degrees, 10.0, 170.0, " degrees");
  s.vertical_fov = raw.fov_degrees * std::numbers::pi / 180;
  demand_range("--ipd", s.ipd, 0.001, 1.0, " metres");
  const auto lens = render::parse_lens(raw.lens);
  if (!lens) refuse_option("--lens", raw.lens, "none, generic, K1,K2 or K1,K2,K1,K2,K1,K2, each -10..10");
  s.lens = *lens;
  demand_range("--rate", s.rate, 0.0, 1000.0);
  demand_range("--pose-rate", s.pose_rate, 1.0, 1000.0);
  s.duration = parse_seconds("--duration", raw.duration_s, 1e6);
  s.warm_up = parse_seconds("--warm-up", raw.warm_up_s, 3600);
  if (s.duration != Duration{} && s.warm_up >= s.duration) {
    refuse_option("--warm-up", fmt::format("{}", raw.warm_up_s),
                  fmt::format("less than --duration, which is {} s", raw.duration_s));
  }
  demand_range("--decoder-threads", s.decoder_threads, 1U, 16U);
}

void apply_output(const Raw& raw, ClientSettings& s) {
  s.out = raw.out;
  demand_range("--samples", s.samples, 1U, 1000U);
  if (s.png_every != 0 && s.out.empty())
    refuse_option("--png-every", std::to_string(s.png_every), "0 without --out");
  constexpr std::array kLevels{"trace", "debug", "info", "warn", "error", "off"};
  if (std::find(kLevels.begin(), kLevels.end(), raw.log_level) == kLevels.end()) {
    refuse_option("--log-level", raw.log_level, fmt::format("one of {}", fmt::join(kLevels, ", ")));
  }
  s.log.level = s.quiet ? spdlog::level::warn : spdlog::level::from_str(raw.log_level);
}

}  // namespace

Options parse_options(int argc, const char* const* argv) {
  Options options;
  Raw raw;
  CLI::App app{
      "atlas-client: redraws a shading atlas streamed by atlasd for its newest pose, and measures it",
      "atlas-client"};
  app.footer(kFooter);
  app.set_version_flag("--version", std::string("atlas-client ") + kVersion);
  app.set_config("--config", "", "Read options from this TOML file; the command line wins");
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.option_defaults()->always_capture_default();
  add_connection_options(app, raw);
  add_view_options(app, options.settings, raw);
  add_output_options(app, options.settings, raw);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return {false, {}, app.help()};
  } catch (const CLI::CallForVersion&) {
    return {false, {}, app.version() + "\n"};
  } catch (const CLI::ParseError& e) {
    throw ProgramError(ExitCode::kUsage, std::string(e.what()) + "; see atlas-client --help");
  }
  options.settings.server = parse_server(raw.connect);
  apply_wishes(raw, options.settings);
  apply_emphasis(raw, options.settings);
  apply_view(raw, options.settings);
  apply_output(raw, options.settings);
  return options;
}

}  // namespace atlaswire::client
