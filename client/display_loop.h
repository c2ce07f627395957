#pragma once

#include "base/time.h"
#include "base/units.h"
#include "client/distribution.h"
#include "client/hand_over.h"
#include "client/pair.h"
#include "client/sample.h"
#include "client/session_types.h"
#include "client/stage_log.h"
#include "client/tracker.h"
#include "render/camera.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

namespace atlaswire::client {

class PairRenderer;
class PictureWriter;

struct DisplaySettings {
  render::Camera camera;  ///< all but the pose
  double rate = 60;       ///< Hz; 0: as fast as possible
  Duration duration{};    ///< from the first pair; 0: until told to stop
  Duration warm_up{};     ///< of it, not measured
  Duration first_pair_patience = std::chrono::seconds(60);
  std::uint32_t samples = 0;    ///< kept for comparison; 0: none
  bool at_server_pose = false;  ///< samples are drawn at the pose that the server rendered for
  std::uint32_t png_every = 0;
  std::filesystem::path png_folder;
};

/// Called from the display loop, on its thread.
struct DisplayHooks {
  std::function<bool()> should_stop;
  /// About once a second; `displayed` counts from the first pair.
  std::function<void(const Progress&)> on_progress;
  /// Once, when the warm-up is over.
  std::function<void(Time)> on_measuring;
};

/// What was displayed.
struct DisplayOutcome {
  std::optional<Time> first;  ///< start of the first displayed frame; nullopt: no pair ever came
  Time measured_from{};       ///< after the warm-up
  Time end{};
  std::uint64_t displayed = 0;  ///< all
  std::uint64_t displayed_measured = 0;
  std::uint64_t paired_measured = 0;  ///< pairs first shown while measuring
  Distribution motion_to_photon;      ///< ms from sampling the drawn pose to its picture, measured frames
  StageLog log;
  std::vector<Sample> samples;
};

/// Draws the newest pair for the newest pose at display rate ([SAS] 3.6) on the calling thread, until the
/// time is over. `writer` may be null. The tracker has its motion.
DisplayOutcome run_display(const DisplaySettings& settings, Tracker& tracker, HandOver<Pair>& pairs,
                           PairRenderer& renderer, PictureWriter* writer, const DisplayHooks& hooks);

}  // namespace atlaswire::client
