#pragma once

#include "base/time.h"
#include "base/units.h"

#include <optional>

namespace atlaswire::server {

/// Keeps the video at its bit rate when frames come more slowly than the encoder was told: encoders count
/// frames, not time, so each frame's share is set by telling a rate that is higher by the same factor.
class RateFitter {
 public:
  /// `target`: bits a second on the wire; nullopt: the encoder's own, left alone.
  RateFitter(std::optional<BitRate> target, double nominal_fps);

  /// Time between the starts of two frames. Pauses beyond a second count as one.
  void on_interval(Duration interval);
  /// The rate to tell the encoder now: at first, and whenever it is off by more than 15 %.
  std::optional<BitRate> take();

 private:
  [[nodiscard]] double wanted() const;

  std::optional<BitRate> target_;
  double nominal_fps_;
  Duration interval_;
  double told_ = 0;  ///< bits per second; 0: nothing yet
};

}  // namespace atlaswire::server
