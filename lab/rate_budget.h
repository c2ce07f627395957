#pragma once

#include "base/units.h"

#include <algorithm>
#include <cstdint>

namespace atlaswire::lab {

/// Holds a stream to one rate for all its channels: what the other channels took is owed, and the video pays
/// it back at half its share at most, so that a burst of geometry dims the picture and never blacks it out.
class RateBudget {
 public:
  /// `total` > 0; `frame_rate` in Hz, > 0.
  RateBudget(BitRate total, double frame_rate)
      : per_frame_(static_cast<double>(total.bits_per_second) / frame_rate), frame_rate_(frame_rate) {}

  /// The rate that the next frame's video may run at.
  [[nodiscard]] BitRate video_rate() const {
    const double paid = std::min(owed_, per_frame_ / 2);
    return {static_cast<std::uint64_t>((per_frame_ - paid) * frame_rate_)};
  }
  /// A frame is made; `others`: octets of it that are not video.
  void on_frame(std::uint64_t others) {
    owed_ = std::max(0.0, owed_ - per_frame_ / 2) + 8.0 * static_cast<double>(others);
  }

 private:
  double per_frame_;  ///< bits
  double frame_rate_;
  double owed_ = 0;  ///< bits
};

}  // namespace atlaswire::lab
