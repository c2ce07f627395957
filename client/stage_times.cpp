#include "client/stage_times.h"

#include <algorithm>

namespace atlaswire::client {

const char* name(Stage stage) {
  switch (stage) {
    case Stage::kClientToServer:
      return "client_to_server";
    case Stage::kServerIdle:
      return "server_idle";
    case Stage::kServerProcessing:
      return "server_processing";
    case Stage::kServerToClient:
      return "server_to_client";
    case Stage::kClientDecoding:
      return "client_decoding";
    case Stage::kClientIdle:
      return "client_idle";
    case Stage::kClientRendering:
      return "client_rendering";
    case Stage::kDisplayAge:
      return "display_age";
  }
  return "unknown";
}

StageDurations stage_durations(const PairTimes& pair, const DrawTimes& draw) {
  const Time arrival = std::max(pair.video_arrival, pair.meta_arrival);
  const bool posed = pair.pose_sampled.has_value();
  return {posed ? pair.pose_received - *pair.pose_sampled : Duration{},
          posed ? pair.render_start - pair.pose_received : Duration{},
          pair.encode_end - pair.render_start,
          arrival - pair.encode_end,
          pair.ready - arrival,
          draw.first_start - pair.ready,
          draw.end - draw.start,
          draw.end - draw.first_end};
}

std::optional<Duration> pose_to_display(const PairTimes& pair, const DrawTimes& draw) {
  if (!pair.pose_sampled) return std::nullopt;
  return draw.end - *pair.pose_sampled;
}

}  // namespace atlaswire::client
