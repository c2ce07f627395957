#include "lab/live_run.h"

#include "base/program.h"
#include "lab/child_process.h"
#include "lab/keys.h"
#include "lab/lab_error.h"
#include "lab/store.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string_view>

namespace atlaswire::lab {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::json;
namespace fs = std::filesystem;

/// Keys that the programs have options for; others must be at their default.
constexpr std::string_view kHonoured[]{"scene",
                                       "path",
                                       "seconds",
                                       "display",
                                       "horizontal_fov",
                                       "stereo",
                                       "ipd",
                                       "lens",
                                       "method",
                                       "atlas",
                                       "views",
                                       "hold_frames",
                                       "fov_scale",
                                       "id_scale",
                                       "max_oversampling",
                                       "foveation",
                                       "grid_bits",
                                       "meta_codec",
                                       "new_patches",
                                       "prediction_step_ms",
                                       "reshade_interval",
                                       "server_hz",
                                       "client_hz",
                                       "profile",
                                       "seed",
                                       "bitrate_mbps",
                                       "qp",
                                       "preset",
                                       "intra_interval"};

Result<void> check_live(const PointSettings& settings) {
  const PointSettings defaults;
  for (const Key& key : keys()) {
    const bool honoured =
        std::find(std::begin(kHonoured), std::end(kHonoured), key.name) != std::end(kHonoured);
    const bool measuring = key.name == "measure_every" || key.name == "measure_flip";
    const std::string text = value_text(key, settings);
    if (honoured || measuring || text == value_text(key, defaults)) continue;
    return Error{LabError::kOutOfRange,
                 fmt::format("{} = {}: a live experiment cannot honour it", key.name, text)};
  }
  if (settings.method != "sas")
    return Error{LabError::kOutOfRange, "method = " + settings.method + ": atlasd streams sas"};
  return {};
}

/// The client is told a vertical field of view.
double vertical_fov_degrees(const PointSettings& s) {
  const double half = s.horizontal_fov * std::numbers::pi / 360;
  const double aspect = static_cast<double>(s.display.height) / s.display.width;
  return std::atan(std::tan(half) * aspect) * 360 / std::numbers::pi;
}

std::string extent_text(const Extent2D& e) { return fmt::format("{}x{}", e.width, e.height); }

std::vector<std::string> daemon_command(const PointSettings& s, const fs::path& bin, const fs::path& out) {
  std::vector<std::string> words{(bin / "atlasd").string(),
                                 "--scene",
                                 s.scene,
                                 "--port",
                                 "0",
                                 "--ready-file",
                                 (out / "atlasd.json").string(),
                                 "--atlas",
                                 extent_text(s.atlas),
                                 "--hold-frames",
                                 fmt::format("{}", s.hold_frames),
                                 "--fov-scale",
                                 fmt::format("{}", s.fov_scale),
                                 "--id-scale",
                                 fmt::format("{}", s.id_scale),
                                 "--max-oversampling",
                                 fmt::format("{}", s.max_oversampling),
                                 "--foveation",
                                 fmt::format("{}", s.foveation),
                                 "--views",
                                 fmt::format("{}", s.views),
                                 "--prediction-step",
                                 fmt::format("{}", s.prediction_step_ms),
                                 "--reshade-interval",
                                 fmt::format("{}", s.reshade_interval),
                                 "--grid-bits",
                                 fmt::format("{}", s.grid_bits),
                                 "--meta-codec",
                                 s.meta_codec,
                                 "--new-patches",
                                 fmt::format("{}", s.new_patches),
                                 "--fps",
                                 fmt::format("{}", s.server_hz),
                                 "--preset",
                                 s.preset,
                                 "--intra-interval",
                                 fmt::format("{}", s.intra_interval)};
  const bool by_rate = s.qp < 0 && s.bitrate_mbps > 0;
  words.insert(words.end(), {"--bitrate", by_rate ? fmt::format("{:.0f}", s.bitrate_mbps * 1e6) : "0"});
  if (s.qp >= 0) words.insert(words.end(), {"--qp", fmt::format("{}", s.qp)});
  return words;
}

/// Waits until a program has said on which port it listens.
int wait_for_port(ChildProcess& process, const fs::path& ready, const char* name,
                  const PointOutputs& outputs) {
  for (;;) {
    if (const auto text = read_whole(ready)) return Json::parse(*text).at("port").get<int>();
    if (process.ended()) {
      throw ProgramError(ExitCode::kInternal,
                         fmt::format("{} did not start: {}", name, last_line(process.error_text())));
    }
    if (outputs.should_stop && outputs.should_stop()) throw Interrupted{};
    wait_for_any({&process}, 50ms);
  }
}

}  // namespace

Result<LiveCommands> live_commands(const PointSettings& s, const fs::path& bin, const fs::path& out) {
  if (auto ok = check_live(s); ok.has_error()) return ok.error();
  LiveCommands commands;
  commands.daemon = daemon_command(s, bin, out);
  if (!s.profile.empty()) {
    commands.relay = {(bin / "atlas-netsim").string(),
                      "--listen",
                      "0",
                      "--profile",
                      s.profile,
                      "--seed",
                      fmt::format("{}", s.seed),
                      "--ready-file",
                      (out / "netsim.json").string()};
  }
  commands.client = {(bin / "atlas-client").string(),
                     "--path",
                     s.path,
                     "--size",
                     extent_text(s.display),
                     "--fov",
                     fmt::format("{:.6f}", vertical_fov_degrees(s)),
                     "--lens",
                     s.lens,
                     "--rate",
                     fmt::format("{}", s.client_hz),
                     "--duration",
                     fmt::format("{}", s.seconds),
                     "--warm-up",
                     fmt::format("{}", std::min(1.0, s.seconds / 4)),
                     "--reference",
                     s.scene,
                     "--out",
                     out.string(),
                     "--quiet"};
  if (s.stereo)
    commands.client.insert(commands.client.end(), {"--stereo", "--ipd", fmt::format("{}", s.ipd)});
  return commands;
}

Result<std::vector<Figure>> live_timings(const std::string& summary_json) {
  try {
    const Json j = Json::parse(summary_json);
    std::vector<Figure> timings;
    for (const char* stage : {"client_to_server", "server_idle", "server_processing", "server_to_client",
                              "client_decoding", "client_idle", "client_rendering", "display_age"}) {
      timings.push_back({stage, j.at("stages_ms").at(stage).get<double>()});
    }
    timings.push_back({"pose_to_display", j.at("latency_ms").at("pose_to_display").at("mean").get<double>()});
    timings.push_back({"server_fps", j.at("server").at("fps").get<double>()});
    timings.push_back({"client_fps", j.at("client").at("fps").get<double>()});
    timings.push_back({"video_mbps", j.at("video").at("mbps").get<double>()});
    timings.push_back({"meta_mbps", j.at("meta").at("mbps").get<double>()});
    for (const char* quality : {"mssim", "mssim_lowest", "psnr"}) {
      timings.push_back({quality, j.contains(quality) && j[quality].is_number() ? j[quality].get<double>()
                                                                                : kNotApplicable});
    }
    timings.push_back({"holes", j.contains("coverage") ? 1 - j["coverage"].get<double>() : kNotApplicable});
    timings.push_back({"frames_lost", j.at("frames").at("lost").get<double>()});
    return timings;
  } catch (const Json::exception& e) {
    return Error{LabError::kBadRecord, std::string("summary.json: ") + e.what()};
  }
}

PointResult run_live(const PointSettings& settings, const PointOutputs& outputs) {
  const fs::path out = outputs.pictures;
  auto commands = live_commands(settings, fs::path(own_program()).parent_path(), out);
  if (commands.has_error()) throw ProgramError(ExitCode::kUsage, commands.error().message());
  ChildProcess daemon(commands->daemon);
  int port = wait_for_port(daemon, out / "atlasd.json", "atlasd", outputs);
  std::optional<ChildProcess> relay;
  if (!commands->relay.empty()) {
    commands->relay.insert(commands->relay.end(), {"--to", fmt::format("127.0.0.1:{}", port)});
    relay.emplace(commands->relay);
    port = wait_for_port(*relay, out / "netsim.json", "atlas-netsim", outputs);
  }
  commands->client.insert(commands->client.end(), {"--connect", fmt::format("127.0.0.1:{}", port)});
  ChildProcess client(commands->client);
  const auto start = std::chrono::steady_clock::now();
  while (!client.ended()) {
    if (outputs.should_stop && outputs.should_stop()) throw Interrupted{};
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    if (outputs.progress) outputs.progress(std::min(0.95, elapsed.count() / (settings.seconds + 5)));
    daemon.read_some();
    if (relay) relay->read_some();
    wait_for_any({&client}, 100ms);
  }
  if (const int code = *client.ended(); code != 0) {
    throw ProgramError(ExitCode::kInternal, fmt::format("atlas-client ended with code {}: {}", code,
                                                        last_line(client.error_text())));
  }
  if (relay) relay->stop(3s);
  daemon.stop(5s);
  const auto summary = read_whole(out / "summary.json");
  auto timings = live_timings(summary.value_or(""));
  if (timings.has_error()) throw ProgramError(ExitCode::kInternal, timings.error().message());
  PointResult result;
  result.timings = *std::move(timings);
  return result;
}

}  // namespace atlaswire::lab
