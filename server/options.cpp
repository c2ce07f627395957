#include "base/host_port.h"
#include "base/option_check.h"
#include "base/program.h"
#include "base/version.h"
#include "server/settings.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>

namespace atlaswire::server {

namespace {

constexpr const char* kHostPortRule = "HOST:PORT or [IPV6]:PORT, port 1..65535";

constexpr const char* kFooter = R"(Examples:
  atlasd --scene atrium                       stream the built-in scene on 127.0.0.1:7400
  atlasd --scene town.glb --listen 0.0.0.0 --atlas 2048x2048 --bitrate 20M
  atlasd --config atlasd.toml --json-logs     options as TOML keys without dashes: scene = "town.glb"
  atlasd --mirror 127.0.0.1:5004 --print-sdp > stream.sdp
      then, while a client is connected:  ffplay -protocol_whitelist file,udp,rtp -i stream.sdp
      (a late joiner sees the picture from the next I-frame on: --intra-interval frames at most)
  atlasd --scene town.glb --explain-scene     what the scene needs, and what it is spared

Exit codes: 0 done, 2 usage, 3 scene, 4 no Vulkan device, 5 port in use, 9 cannot write a file.
SIGTERM or SIGINT drains: clients get a goodbye within 2 s; a second signal ends at once.
SIGHUP reads --config again and takes foveation and priority from it; SIGUSR1 draws --layout-picture.)";

/// The texts and numbers that become other types after parsing.
struct Raw {
  std::string atlas = "1024x1024";
  std::string bit_rate = "10M";
  std::string cover = "auto";
  std::string allocator = "auto";
  std::string layout_colours = "class";
  std::string meta_codec = name(StreamSettings{}.meta_codec);
  std::string mirror;
  std::string log_level = "info";
  std::vector<std::string> priorities;
  double foveation = 0;
  double prediction_step_ms = 1000.0 / 30;
  double stats_interval_s = 5;
  double max_runtime_s = 0;
  double hello_timeout_s = 5;
  double idle_timeout_s = 10;
  int port = 7400;
  bool explain_scene = false;
  bool list_devices = false;
};

void add_scene_options(CLI::App& app, DaemonSettings& s, Raw& raw) {
  auto* group = app.add_option_group("Scene and device");
  group->add_option("--scene", s.scene,
                    "Built-in scene (atrium, atrium:DETAIL, parade) or a glTF file (.gltf, .glb)");
  group->add_option(
      "--device", s.device,
      "auto, an index of --list-devices, or part of a Vulkan device's name; llvmpipe is the CPU");
  group->add_flag("--validation", s.validation, "Vulkan validation layer: finds faults, slows start-up");
  group->add_flag("--explain-scene", raw.explain_scene, "Print what the scene requires, and why; then exit");
  group->add_flag("--list-devices", raw.list_devices, "Print the Vulkan devices; then exit");
}

void add_picture_options(CLI::App& app, DaemonSettings& s, Raw& raw) {
  auto& render = s.stream.render;
  auto* group = app.add_option_group("Picture");
  group->add_option("--method", s.stream.method, "How views become frames");
  group->add_option(
      "--atlas", raw.atlas,
      "Atlas WxH in texels, multiples of 64: detail against shading time, bitrate and decoding");
  group->add_option("--fov-scale", render.fov_scale,
                    "Enlarged field of view, 1..2: room to turn the head against patches nobody looks at");
  group->add_option("--id-scale", render.id_scale,
                    "Id buffer pixels per display pixel, 0.25..2: small triangles against visibility time");
  group->add_option("--views", render.max_views,
                    "Predicted views united, 1..16: fewer holes when moving against visibility time");
  group->add_option(
      "--hold-frames", render.hold_frames,
      "Frames that a patch stays after it was last seen, 0..1000: fewer holes and geometry bytes "
      "against atlas memory");
  group->add_option("--cover", raw.cover,
                    "Latency to cover in ms, or auto (measured): fewer holes against a larger visible set");
  group->add_option("--prediction-step", raw.prediction_step_ms,
                    "Largest time between predicted views, ms, 1..1000");
  group->add_option("--max-oversampling", render.max_oversampling,
                    "Texels a pixel may get while the atlas has room, 1..8: sharper against more shading");
  group->add_option("--foveation", raw.foveation,
                    "Octaves of atlas area that surfaces lose per radian away from the view axis, 0..8: a "
                    "sharper centre against the rim");
  group->add_option("--priority", raw.priorities,
                    "NAME=OCTAVES, once for each: atlas area of a material or object (see --explain-scene) "
                    "beside what its size on screen asks for, -8..8");
  group->add_option("--allocator", raw.allocator,
                    "Who lays the atlas out: device, sequential (on the host), or auto: the device unless it "
                    "is a CPU; the layout is the same");
  group->add_option(
      "--level-hysteresis", render.level_hysteresis,
      "Octaves past the border between two block sizes before a block changes, 0..1: blocks that "
      "stay against the best size for each");
  group->add_option(
      "--meta-codec", raw.meta_codec,
      "How geometry travels to clients that know it: mirror (fewest bytes: they lay the atlas out "
      "themselves), gate, plain or paper ([SAS] 6.5)");
  group->add_option(
      "--new-patches", render.most_new_patches,
      "Patches a frame may show for the first time, the largest first, 16..1000000, or 0: all: an "
      "early first picture against one that is whole at once");
  group->add_option("--reshade-interval", render.reshade_interval,
                    "Shade each block at least every N-th frame, 1..60: speed against stale reflections");
  group->add_flag("--foresee-motion", s.stream.foresee_motion,
                  "Show what moves where it will be when the picture is displayed: no lag, but only clips "
                  "can be foreseen");
  group->add_option(
      "--grid-bits", s.stream.grid_bits,
      "Bits an axis of client vertex positions, 8..20, or 0: as many as a step of 2 mm needs, 16 to 20");
}

void add_video_options(CLI::App& app, DaemonSettings& s, Raw& raw) {
  auto& video = s.stream.video;
  auto* group = app.add_option_group("Video");
  group->add_option("--bitrate", raw.bit_rate,
                    "Video rate such as 10M or 800k; 0: constant quality by --qp, whatever it costs");
  group->add_option("--qp", video.qp,
                    "H.264 quantizer when --bitrate is 0, 0..51: lower is better and larger");
  group->add_option("--fps", s.stream.max_fps,
                    "Server frames a second at most, 0.1..240: fresher shading against load and bitrate");
  group->add_option("--intra-interval", video.intra_interval,
                    "Frames from I-frame to I-frame, 0..10000 (0: only on request): recovery against bytes");
  group->add_option("--encoder", video.encoder, "auto, h264_nvenc, h264_vaapi or libx264");
  group->add_option("--preset", video.preset,
                    "x264 preset, ultrafast..veryslow: bytes against encoding time");
  group->add_option("--encoder-threads", video.threads,
                    "Slices encoded side by side, 1..16: speed against a little compression");
}

void add_network_options(CLI::App& app, DaemonSettings& s, Raw& raw) {
  auto* group = app.add_option_group("Network");
  group->add_option("--listen", s.listen, "Address to listen on; 0.0.0.0 or :: lets other machines in");
  group->add_option("--port", raw.port, "TCP and UDP port, 0..65535; 0: any free one (see --ready-file)");
  group->add_option("--max-sessions", s.admission.max_sessions,
                    "Clients streamed to at once, 1..1024; each costs a whole stream of its own");
  group->add_option("--max-connections", s.admission.max_connections, "TCP connections at once, 1..65536");
  group->add_option("--max-connections-per-address", s.admission.max_connections_per_address,
                    "TCP connections at once from one address, 1..65536");
  group->add_option("--hello-timeout", raw.hello_timeout_s,
                    "Seconds a client has from connecting to its first valid datagram, 0.1..600");
  group->add_option("--idle-timeout", raw.idle_timeout_s,
                    "Seconds without a pose or report until a session ends, 0.1..3600");
  group->add_option("--max-datagram", s.delivery.max_datagram,
                    "Octets of a media datagram at most, 200..1400: fewer packets against the path's MTU");
  group->add_option("--pacing", s.delivery.pacing,
                    "Frames leave at this multiple of --bitrate, 1..100: latency against bursts");
  group->add_option("--mirror", raw.mirror,
                    "HOST:PORT that gets a copy of the first live stream's RTP, for ffplay or GStreamer");
}

void add_report_options(CLI::App& app, DaemonSettings& s, Raw& raw) {
  auto* group = app.add_option_group("Reports");
  group->add_flag(
      "--print-sdp", s.print_sdp,
      "Print the mirrored stream's SDP on stdout and go on serving; mirrors to 127.0.0.1:5004 if not told");
  group->add_option("--ready-file", s.ready_file,
                    R"(Write {"port":N,"pid":N} here, atomically, once clients may connect)");
  group->add_option("--stats-interval", raw.stats_interval_s, "Seconds between statistics lines; 0: none");
  group->add_option("--stats-csv", s.stats_csv,
                    "Write a line per frame: stage times, bytes, visible patches, the atlas's memory");
  group->add_option("--layout-picture", s.layout_picture,
                    "PNG of the first live session's atlas memory, drawn anew at each SIGUSR1");
  group->add_option("--layout-colours", raw.layout_colours,
                    "What its colours tell: class (in use, fragmented, free), level (size) or age of blocks");
  group->add_option("--max-runtime", raw.max_runtime_s, "Drain and exit 0 after this many seconds; 0: never");
  group->add_option("--log-level", raw.log_level, "trace, debug, info, warn, error or off");
  group->add_flag("--json-logs", s.log.json, "Log one JSON object a line on stderr");
}

Duration parse_seconds(const char* option, double seconds, double low, double high) {
  demand_range(option, seconds, low, high, " seconds");
  return from_seconds(seconds);
}

void apply_cover(const std::string& text, CoverSettings& cover) {
  if (text == "auto") return;
  double ms = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, ms);
  const bool whole = parsed.ec == std::errc{} && parsed.ptr == end;
  if (!whole || !(ms >= 0 && ms <= 10'000)) refuse_option("--cover", text, "auto or 0..10000 (ms)");
  cover.fixed = from_seconds(ms / 1000);
}

render::AllocatorKind parse_allocator(const std::string& text) {
  if (text == "device") return render::AllocatorKind::kDevice;
  if (text == "sequential") return render::AllocatorKind::kSequential;
  if (text != "auto") refuse_option("--allocator", text, "auto, device or sequential");
  return render::AllocatorKind::kAuto;
}

Emphasis parse_emphasis(const Raw& raw) {
  demand_range("--foveation", raw.foveation, 0.0, Emphasis::kMostFoveation);
  Emphasis emphasis{.foveation = raw.foveation};
  for (const std::string& text : raw.priorities) {
    auto priority = parse_surface_priority(text);
    if (!priority) refuse_option("--priority", text, "NAME=OCTAVES, -8..8");
    emphasis.priorities.push_back(*std::move(priority));
  }
  return emphasis;
}

void apply_picture(const Raw& raw, StreamSettings& s) {
  auto& render = s.render;
  const auto atlas = parse_extent(raw.atlas);
  const auto fits = [](std::uint32_t side) { return side >= 64 && side <= 8192 && side % 64 == 0; };
  if (!atlas || !fits(atlas->width) || !fits(atlas->height)) {
    refuse_option("--atlas", raw.atlas, "WxH, each side a multiple of 64 in 64..8192");
  }
  render.atlas = *atlas;
  render.allocator.atlas = *atlas;
  render.allocator.superblock_log2 = render::suited_superblock_log2(*atlas);
  // Methods without an atlas are there to compare with: sessions have no way to send their frames.
  if (s.method != "sas") refuse_option("--method", s.method, "sas");
  demand_range("--fov-scale", render.fov_scale, 1.0, 2.0);
  demand_range("--id-scale", render.id_scale, 0.25, 2.0);
  demand_range("--views", render.max_views, 1U, 16U);
  demand_range("--hold-frames", render.hold_frames, 0U, 1000U);
  demand_range("--prediction-step", raw.prediction_step_ms, 1.0, 1000.0, " ms");
  render.prediction_step = from_seconds(raw.prediction_step_ms / 1000);
  demand_range("--max-oversampling", render.max_oversampling, 1.0, 8.0);
  render.allocator_kind = parse_allocator(raw.allocator);
  render.emphasis = parse_emphasis(raw);
  demand_range("--level-hysteresis", render.level_hysteresis, 0.0, 1.0);
  if (render.most_new_patches != 0) demand_range("--new-patches", render.most_new_patches, 16U, 1'000'000U);
  demand_range("--reshade-interval", render.reshade_interval, 1U, 60U);
  if (s.grid_bits != 0) demand_range("--grid-bits", s.grid_bits, 8U, 20U);
  const auto meta_codec = codec::find_meta_codec(raw.meta_codec);
  if (!meta_codec) refuse_option("--meta-codec", raw.meta_codec, "mirror, gate, plain or paper");
  s.meta_codec = *meta_codec;
  apply_cover(raw.cover, s.cover);
}

void apply_video(const Raw& raw, StreamSettings& s) {
  auto& video = s.video;
  const auto rate = parse_bit_rate(raw.bit_rate);
  if (!rate || (rate->bits_per_second != 0 && rate->bits_per_second < 10'000) ||
      rate->bits_per_second > 2'000'000'000) {
    refuse_option("--bitrate", raw.bit_rate, "0 or a rate such as 800k or 10M, 10k..2G");
  }
  video.bit_rate = *rate;
  demand_range("--qp", video.qp, 0, 51);
  demand_range("--fps", s.max_fps, 0.1, 240.0);
  video.frame_rate = s.max_fps;
  demand_range("--intra-interval", video.intra_interval, 0U, 10'000U);
  demand_range("--encoder-threads", video.threads, 1U, 16U);
  constexpr std::array kEncoders{"auto", "h264_nvenc", "h264_vaapi", "libx264"};
  if (std::find(kEncoders.begin(), kEncoders.end(), video.encoder) == kEncoders.end()) {
    refuse_option("--encoder", video.encoder, fmt::format("one of {}", fmt::join(kEncoders, ", ")));
  }
  constexpr std::array kPresets{"ultrafast", "superfast", "veryfast", "faster",  "fast",
                                "medium",    "slow",      "slower",   "veryslow"};
  if (std::find(kPresets.begin(), kPresets.end(), video.preset) == kPresets.end()) {
    refuse_option("--preset", video.preset, fmt::format("one of {}", fmt::join(kPresets, ", ")));
  }
}

void apply_network(const Raw& raw, DaemonSettings& s) {
  demand_range("--port", raw.port, 0, 65'535);
  s.port = static_cast<std::uint16_t>(raw.port);
  demand_range("--max-sessions", s.admission.max_sessions, 1U, 1024U);
  demand_range("--max-connections", s.admission.max_connections, 1U, 65'536U);
  demand_range("--max-connections-per-address", s.admission.max_connections_per_address, 1U, 65'536U);
  s.admission.hello_timeout = parse_seconds("--hello-timeout", raw.hello_timeout_s, 0.1, 600);
  s.admission.idle_timeout = parse_seconds("--idle-timeout", raw.idle_timeout_s, 0.1, 3600);
  demand_range("--max-datagram", s.delivery.max_datagram, 200U, 1400U);
  demand_range("--pacing", s.delivery.pacing, 1.0, 100.0);
  if (!raw.mirror.empty()) {
    s.mirror = parse_host_port(raw.mirror);
    if (!s.mirror || s.mirror->port == 0) refuse_option("--mirror", raw.mirror, kHostPortRule);
  }
  if (s.print_sdp && !s.mirror) s.mirror = HostPort{"127.0.0.1", 5004};
}

void apply_reports(const Raw& raw, DaemonSettings& s) {
  constexpr std::array kColours{"class", "level", "age"};  // in the order of render::LayoutColours
  const auto colours = std::find(kColours.begin(), kColours.end(), raw.layout_colours);
  if (colours == kColours.end()) refuse_option("--layout-colours", raw.layout_colours, "class, level or age");
  if (!s.layout_picture.empty()) {
    s.stream.layout_colours = static_cast<render::LayoutColours>(colours - kColours.begin());
  }
  s.stats_interval = parse_seconds("--stats-interval", raw.stats_interval_s, 0, 86'400);
  s.max_runtime = parse_seconds("--max-runtime", raw.max_runtime_s, 0, 1e9);
  constexpr std::array kLevels{"trace", "debug", "info", "warn", "error", "off"};
  if (std::find(kLevels.begin(), kLevels.end(), raw.log_level) == kLevels.end()) {
    refuse_option("--log-level", raw.log_level, fmt::format("one of {}", fmt::join(kLevels, ", ")));
  }
  s.log.level = spdlog::level::from_str(raw.log_level);
}

Mode mode_of(const Raw& raw) {
  if (raw.list_devices) return Mode::kListDevices;
  return raw.explain_scene ? Mode::kExplainScene : Mode::kServe;
}

}  // namespace

Options parse_options(int argc, const char* const* argv) {
  Options options;
  Raw raw;
  CLI::App app{"atlasd: renders a scene's potentially visible surfaces into a texture atlas and streams it",
               "atlasd"};
  app.footer(kFooter);
  app.set_version_flag("--version", std::string("atlasd ") + kVersion);
  app.set_config("--config", "", "Read options from this TOML file; the command line wins");
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.option_defaults()->always_capture_default();
  add_scene_options(app, options.settings, raw);
  add_picture_options(app, options.settings, raw);
  add_video_options(app, options.settings, raw);
  add_network_options(app, options.settings, raw);
  add_report_options(app, options.settings, raw);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return {Mode::kPrint, {}, app.help()};
  } catch (const CLI::CallForVersion&) {
    return {Mode::kPrint, {}, app.version() + "\n"};
  } catch (const CLI::ParseError& e) {
    throw ProgramError(ExitCode::kUsage, std::string(e.what()) + "; see atlasd --help");
  }
  apply_picture(raw, options.settings.stream);
  apply_video(raw, options.settings.stream);
  apply_network(raw, options.settings);
  apply_reports(raw, options.settings);
  options.mode = mode_of(raw);
  options.has_config = app.get_config_ptr()->count() > 0;
  return options;
}

}  // namespace atlaswire::server
