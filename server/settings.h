#pragma once

#include "base/host_port.h"
#include "base/log.h"
#include "base/time.h"
#include "base/units.h"
#include "codec/meta_update.h"
#include "codec/video.h"
#include "render/atlas/usage_overlay.h"
#include "render/method.h"

#include <cstdint>
#include <optional>
#include <string>

namespace atlaswire::server {

using namespace std::chrono_literals;

/// How far ahead of a pose its frame must still be right ([SAS] 3.1): a fixed time, or from measurement:
/// round trip + own processing and pacing + frame interval + `allowance`, clamped to 0..`most`.
struct CoverSettings {
  std::optional<Duration> fixed;
  Duration allowance = 10ms;  ///< the client's own waiting and drawing
  Duration most = 500ms;
};

/// What one stream is made with. `render` and `video` are passed on as they are; `video.extent` follows
/// the method's picture.
struct StreamSettings {
  std::string method = "sas";
  render::MethodSettings render;
  codec::VideoEncoderSettings video;
  double max_fps = 15;  ///< frames a second that are started at most, > 0
  std::uint32_t grid_bits =
      0;  ///< of the client replica's position grid, 8..20; 0: PositionGrid::suited_bits
  codec::MetaCodecKind meta_codec = codec::kMetaCodecs.front();  ///< for clients that know it
  CoverSettings cover;
  /// What moves is shown where it will be when the picture is displayed, instead of where it is: clips tell
  /// the future, which a scene that answers to somebody could not.
  bool foresee_motion = false;
  std::optional<render::LayoutColours> layout_colours;  ///< of ViewRequest::layout; nullopt: not followed
};

/// Who may connect, and how long each may stay silent or slow.
struct AdmissionSettings {
  std::uint32_t max_sessions = 8;      ///< streaming clients; others are refused
  std::uint32_t max_connections = 64;  ///< TCP connections in all; others are closed at once
  std::uint32_t max_connections_per_address = 16;
  Duration hello_timeout = 5s;   ///< from connecting to the UDP flow's confirmation
  Duration idle_timeout = 10s;   ///< without a pose or RTCP
  Duration stall_timeout = 10s;  ///< with the TCP queue above its bound
  Duration drain_timeout = 2s;   ///< for goodbyes to leave at shutdown
};

/// How a session's bytes leave.
struct DeliverySettings {
  std::uint32_t max_datagram = 1200;  ///< octets of a media datagram, RTP header included; 200..1400
  double pacing = 4;                  ///< media leaves at this multiple of the bit rate, >= 1
  std::size_t tcp_queue_bytes = std::size_t{8} << 20U;    ///< above it the stream pauses
  std::size_t media_queue_bytes = std::size_t{4} << 20U;  ///< a frame that does not fit is dropped whole
};

/// Everything `atlasd` can be told; server/options.cpp maps options and TOML keys onto it one to one.
struct DaemonSettings {
  std::string scene = "atrium";
  std::string device = "auto";  ///< as render::DeviceSettings::select
  bool validation = false;      ///< Vulkan validation layer
  StreamSettings stream;
  std::string listen = "127.0.0.1";
  std::uint16_t port = 7400;  ///< 0: any free one; TCP and UDP share the number
  AdmissionSettings admission;
  DeliverySettings delivery;
  std::optional<HostPort> mirror;  ///< gets a copy of the first live stream's RTP, beside the clients
  bool print_sdp = false;
  std::string ready_file;        ///< empty: none
  Duration stats_interval = 5s;  ///< 0: no periodic line
  std::string stats_csv;         ///< empty: none
  std::string layout_picture;    ///< PNG that draw_layout() writes; empty: none
  Duration max_runtime{};        ///< 0: until a signal
  LogSettings log;
};

/// What the command line asks for besides serving.
enum class Mode { kServe, kPrint, kExplainScene, kListDevices };

/// The outcome of parsing: what to do, with what, and for kPrint (--help, --version) the text.
struct Options {
  Mode mode = Mode::kServe;
  DaemonSettings settings;
  std::string text;
  bool has_config = false;  ///< read from a file that may be read again
};

/// Reads the command line and the file that --config names (the command line wins). Throws ProgramError
/// (kUsage) with one line that names the option, what was given and what is allowed.
Options parse_options(int argc, const char* const* argv);

}  // namespace atlaswire::server
