#pragma once

#include "render/atlas/allocator.h"

#include <vector>

namespace atlaswire::render {

/// Every live block, kept up by an allocator's changes: what a receiver knows.
class LiveBlocks {
 public:
  void apply(const LayoutChange& change);
  /// Ascending by patch.
  [[nodiscard]] const std::vector<PlacedPatch>& blocks() const { return blocks_; }

 private:
  std::vector<PlacedPatch> blocks_;
  std::vector<PlacedPatch> next_;
};

}  // namespace atlaswire::render
