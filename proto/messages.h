#pragma once

#include "base/bytes.h"
#include "base/emphasis.h"
#include "base/ids.h"
#include "base/result.h"
#include "base/time.h"
#include "base/units.h"
#include "proto/stream_description.h"
#include "proto/tokens.h"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace atlaswire::proto {

/// Versions a program can speak, both ends included.
struct VersionRange {
  std::uint32_t lowest = 1;
  std::uint32_t highest = 1;
};

/// Client to server, first: who I am and what I can do. Every field is checked when parsed.
struct ClientHello {
  VersionRange versions;
  std::string client_name;             ///< at most 128 octets, for logs
  Extent2D display{960, 540};          ///< pixels, sides 16..16384
  double vertical_fov = 1.0471975512;  ///< radians, 0.1..3.0
  double eye_separation = 0;           ///< metres, 0..1; above 0 two such displays are drawn, one an eye
  Extent2D max_picture{4096, 4096};    ///< largest decodable picture, sides 64..16384
  std::vector<std::uint32_t> meta_codecs{1};  ///< codec::MetaCodecKind numbers, 1..16 of them
  bool shows_motion = false;                  ///< else the client is sent moving scenes at rest
  /// Wishes; the server may give something else.
  std::optional<Extent2D> wanted_atlas;     ///< sides 64..16384
  std::optional<BitRate> wanted_bit_rate;   ///< 1 kbit/s..10 Gbit/s
  std::optional<double> wanted_frame_rate;  ///< Hz, 1..240
};

/// Server to client, the answer: a session on a stream.
struct ServerHello {
  std::uint32_t version = 1;
  SessionId session{};  ///< not 0
  UdpToken udp_token{};
  StreamDescription stream;
};

/// Server clock at the ends of a frame's server stages ([SAS] 3).
struct StageStamps {
  Time pose_received{};  ///< the pose the frame was rendered for arrived
  Time render_start{};
  Time render_end{};
  Time encode_end{};
  Time sent{};  ///< handed to the pacer and the reliable channel
};

/// Server to client, once a frame: the meta update that belongs to the picture of the same frame.
struct FrameMeta {
  FrameId frame{};
  PoseId pose{};  ///< of this client; 0: none had arrived
  StageStamps stamps;
  Duration cover{};        ///< how far ahead the visible set reaches; 0..10 s
  ByteBuffer meta;         ///< bytes of the agreed meta codec, may be empty
  Duration scene_time{};   ///< for how long what moves had been moving; only if the stream has motion
  Duration scene_ahead{};  ///< so much later than that it is shown; 0..10 s
  ByteBuffer motion;       ///< codec::MotionEncoder's message; only if the stream has motion
};

/// Server to client instead of a ServerHello; the connection closes after it.
struct Refusal {
  enum class Code : std::uint8_t { kVersion = 1, kCapacity = 2, kBadHello = 3, kDraining = 4 };
  Code code = Code::kBadHello;
  std::string text;  ///< one line for people, at most 1024 octets
};

/// Either way, last: why the connection closes now.
struct Goodbye {
  enum class Reason : std::uint8_t {
    kDone = 1,
    kDraining = 2,
    kProtocolError = 3,
    kTimeout = 4,
    kTooSlow = 5,
    kInternal = 6
  };
  Reason reason = Reason::kDone;
  std::string text;  ///< one line for people, at most 1024 octets
};

/// Client to server, now and then, optional: how it goes.
struct StatsReport {
  FrameId newest_frame{};
  std::uint64_t frames_paired = 0;
  std::uint64_t frames_lost = 0;
  std::uint64_t frames_displayed = 0;
  double display_rate = 0;      ///< Hz, 0..10000
  Duration motion_to_photon{};  ///< median since the last report; 0..60 s
};

/// Client to server: what I know has come apart from what you tell; tell me all anew.
struct RestartRequest {
  FrameId frame{};   ///< whose update showed it
  std::string text;  ///< one line for people, at most 1024 octets
};

/// `atlaswire::Emphasis` is a message too. Client to server, any time after the answer: how its own stream
/// shares out the atlas, from the next frame on. Each replaces the one before as a whole.
using Message = std::variant<ClientHello, ServerHello, FrameMeta, Refusal, Goodbye, StatsReport,
                             RestartRequest, Emphasis>;

/// Parses one envelope (without its length prefix) and checks every field: see envelope.h for what is
/// refused. The error's detail names the field.
Result<Message> parse_message(ByteView envelope);

/// Appends `u32 length | envelope` to `out`, ready for the socket. The message must be valid by the rules
/// of `parse_message` (sizes, ranges, at most kMaxEnvelope octets); only texts are made plain and cut here.
void append_message(const Message& message, ByteBuffer& out);

/// "client hello", "frame meta": for logs and errors.
const char* message_name(const Message& message);
const char* name(Refusal::Code code);
const char* name(Goodbye::Reason reason);

}  // namespace atlaswire::proto
