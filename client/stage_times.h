#pragma once

#include "base/ids.h"
#include "base/time.h"

#include <array>
#include <cstddef>
#include <optional>

namespace atlaswire::client {

/// Where a pair spent its time until it could be shown; every instant on the client's clock (the server's
/// are mapped by clock sync, so they carry its error).
struct PairTimes {
  FrameId frame{};
  PoseId pose{};                     ///< that the server rendered for; 0: none
  std::optional<Time> pose_sampled;  ///< nullopt: the server had no pose of ours
  Time pose_received{};              ///< by the server
  Time render_start{};
  std::optional<Duration> scene_time;  ///< then, of what moves; nullopt: nothing does
  Duration scene_ahead{};              ///< so much later things are in the picture
  Time encode_end{};
  Time video_arrival{};       ///< the picture's last packet
  Time meta_arrival{};        ///< the update's last octet
  Duration video_decoding{};  ///< 5a: in the decoder
  Duration meta_decoding{};   ///< 5b: decoding, replica and vertex buffer
  Time ready{};               ///< picture decoded and vertex buffer built
};

/// One drawing of a pair.
struct DrawTimes {
  Time first_start{};  ///< of the pair's first drawing
  Time first_end{};
  Time start{};  ///< the newest pose is sampled here
  Time end{};    ///< the picture is complete
};

/// The eight durations of [SAS] section 3 in the order of its pipeline.
enum class Stage : std::size_t {
  kClientToServer,    ///< (1) pose sampled to pose received
  kServerIdle,        ///< (2) until a frame starts rendering with it
  kServerProcessing,  ///< (3) visibility, shading, encoding
  kServerToClient,    ///< (4) until both channels delivered: the longest sub-path, as in fig. 16
  kClientDecoding,    ///< (5) from there until both are decoded
  kClientIdle,        ///< (6) until a display frame starts with the pair
  kClientRendering,   ///< (7) that frame's, or this upsampled frame's, drawing
  kDisplayAge,        ///< (8) framerate upsampling: since the pair was first on display; 0 then
};
inline constexpr std::size_t kStageCount = 8;
/// The names of fig. 16 in snake case: "client_to_server".
const char* name(Stage stage);

using StageDurations = std::array<Duration, kStageCount>;

/// Without a pose, stages 1 and 2 are not known, and zero. On a pair's first drawing the first seven add
/// up to the time from the pose's sampling to its picture.
StageDurations stage_durations(const PairTimes& pair, const DrawTimes& draw);

/// Age of the pose behind the shading on display; nullopt without a pose.
std::optional<Duration> pose_to_display(const PairTimes& pair, const DrawTimes& draw);

}  // namespace atlaswire::client
