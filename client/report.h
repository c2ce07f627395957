#pragma once

#include "client/distribution.h"
#include "client/quality.h"
#include "client/settings.h"
#include "client/stage_times.h"
#include "client/traffic.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace atlaswire::client {

/// Everything a run found out. Rates and percentiles are of the measured time, after the warm-up.
struct RunReport {
  ClientSettings settings;
  std::string scene;
  std::string path;
  std::string device;
  Extent2D atlas;
  std::string end;  ///< how the session ended; empty: we ended it

  double measured_s = 0;
  double server_fps = 0;
  double client_fps = 0;
  double pair_fps = 0;
  double video_mbps = 0;
  double meta_mbps = 0;
  double poses_mbps = 0;
  double control_mbps = 0;  ///< both ways

  std::uint64_t frames_announced = 0;  ///< by meta updates, whole run
  std::uint64_t frames_decoded = 0;
  std::uint64_t frames_paired = 0;
  std::uint64_t restarts = 0;            ///< asked for, being out of step with the server
  std::uint64_t frames_never_shown = 0;  ///< pairs overtaken before the display took them
  std::uint64_t frames_lost = 0;         ///< missing packets
  std::uint64_t frames_withheld = 0;     ///< whole, but of no use until an IDR
  std::uint64_t frames_failed = 0;       ///< refused by the decoder
  std::uint64_t frames_overrun = 0;      ///< dropped because the decoder was too slow
  std::uint64_t frames_displayed = 0;
  Traffic traffic;  ///< whole run
  PacketCounts packets;
  std::uint64_t patches = 0;  ///< of the last pair
  std::uint64_t triangles = 0;

  std::array<Summary, kStageCount> stages;
  Summary round_trip;        ///< pose to a pair's first picture, ms: stages 1 to 7
  Summary pose_to_display;   ///< age of the pose behind the shading, every displayed frame, ms
  Summary motion_to_photon;  ///< drawn pose to picture, ms
  bool clock_synchronized = false;
  double clock_error_ms = 0;
  double network_round_trip_ms = 0;

  std::optional<QualitySummary> quality;
  std::vector<Quality> samples;
  std::vector<std::string> files;
  std::uint64_t pictures_left_out = 0;
};

/// summary.json; docs/CLIENT.md lists its members.
std::string to_json(const RunReport& report);
/// The table at a run's end.
std::string to_table(const RunReport& report);

}  // namespace atlaswire::client
