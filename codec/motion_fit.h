#pragma once

#include "codec/motion_models.h"

#include <array>
#include <cstdint>

namespace atlaswire::codec {

/// Finds an encoder's weights: those that would have predicted the last frames' velocities best, by least
/// squares over what was told (rounding noise of the grid included, which is why less than the full second
/// order often does better), forgetting by a tenth a frame. The decoder is told the result.
class MotionFit {
 public:
  using Features = std::array<double, MotionWeights::kCount>;

  /// What a vertex of a weight set had to be predicted from, and what came: one axis, steps. `calmness`
  /// weighs it.
  void note(std::uint32_t set, const Features& features, double velocity, double calmness);
  /// Once a frame: forgets a little, and gives the set's weights anew if enough was noted since they last
  /// changed.
  MotionWeights renew(std::uint32_t set, const MotionWeights& now);

 private:
  struct Sums {
    std::array<Features, MotionWeights::kCount> products{};
    Features with_velocity{};
    std::uint32_t noted = 0;     ///< since the last change
    bool fresh = false;          ///< something was noted in this frame
    std::uint32_t wanted = 256;  ///< before the next change
  };
  std::array<Sums, MotionModels::kWeightSets> sets_{};
};

}  // namespace atlaswire::codec
