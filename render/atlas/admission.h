#pragma once

#include "render/atlas/allocator.h"

#include <cstdint>
#include <vector>

namespace atlaswire::render {

/// Lets patches that were never shown into the atlas at most so many a frame, those with the largest blocks
/// first, so that a viewer who joins, or a door that opens, cannot hold up the frames behind it: the picture
/// begins with what is nearest, and the rest follows. Who was admitted once may always come back.
/// Deterministic; the device's counterpart is shaders/alloc_admit.comp.
class Admission {
 public:
  /// `most_new` patches a frame; 0: any number.
  Admission(std::uint32_t most_new, std::uint32_t patch_count)
      : most_new_(most_new), admitted_(most_new == 0 ? 0 : patch_count) {}

  /// From now on nobody was ever shown.
  void restart() { admitted_.assign(admitted_.size(), false); }
  /// Takes those who must wait out of a frame's requests, which ascend; of equal areas the lowest numbers go
  /// first. Returns how many wait.
  std::uint32_t admit(std::vector<BlockRequest>& requests);

 private:
  std::uint32_t most_new_;
  std::vector<bool> admitted_;  ///< by patch
};

}  // namespace atlaswire::render
