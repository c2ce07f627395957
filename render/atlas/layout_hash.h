#pragma once

#include "base/running_hash.h"
#include "render/atlas/allocator.h"

#include <span>

namespace atlaswire::render {

/// What an allocator did since its last reset, in 32 bits, so that a server and a receiver that runs the same
/// allocator can compare layouts frame by frame. docs/PROTOCOL.md, "Atlas memory".
class LayoutHash {
 public:
  /// A frame without a reset.
  void follow(const LayoutChange& change);
  /// A frame with one: begins anew with every live block, ascending by patch.
  void begin(std::span<const PlacedPatch> live);
  [[nodiscard]] const RunningHash& hash() const { return hash_; }

 private:
  void take_in(std::span<const PlacedPatch> placed);

  RunningHash hash_;
};

}  // namespace atlaswire::render
