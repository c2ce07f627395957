#pragma once

#include <cstdint>

namespace atlaswire::server {

/// Decides which frames are I-frames, before they are rendered, because the atlas may only be rearranged on
/// them. Every `interval` frames by rule; early ones when someone lost a picture or the atlas's memory asks.
/// Counts frames, not time: early ones for memory are at least `memory_spacing` frames apart, ones for
/// losses at least `loss_spacing`, so that feedback of many clients cannot turn the stream into I-frames
/// only.
class IntraSchedule {
 public:
  struct Settings {
    std::uint32_t interval = 5;        ///< 0: only when asked
    std::uint32_t loss_spacing = 2;    ///< frames from an I-frame to one asked for by a loss, >= 1
    std::uint32_t memory_spacing = 8;  ///< likewise for memory, >= 1
  };

  explicit IntraSchedule(const Settings& settings) : settings_(settings) {}

  /// Somebody needs an I-frame; remembered until one is made.
  void ask_for_loss() { loss_ = true; }
  void ask_for_memory() { memory_ = true; }
  /// Somebody has nothing at all: the next frame is one, whatever the spacing.
  void ask_at_once() { at_once_ = true; }
  /// Is the next frame an I-frame? The first always is. Call once a frame.
  bool next();

 private:
  Settings settings_;
  std::uint32_t since_ = 0;  ///< frames since the last I-frame, itself included; 0: none yet
  bool loss_ = false;
  bool memory_ = false;
  bool at_once_ = true;
};

}  // namespace atlaswire::server
