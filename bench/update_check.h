#pragma once

#include "base/grid.h"
#include "codec/meta_update.h"

#include <cstdint>
#include <vector>

namespace atlaswire::bench {

/// Follows both ends of a stream of updates and sees whether they show the same, however vertices are
/// numbered and lists are ordered.
class UpdateCheck {
 public:
  /// Throws std::runtime_error where `heard` says other than `told`.
  void compare(const codec::MetaUpdate& told, const codec::MetaUpdate& heard);

 private:
  std::vector<GridPosition> told_;  ///< by vertex id
  std::vector<GridPosition> heard_;
};

/// Of a mesh's triangles, wherever they stand in it and whichever corner comes first.
std::uint64_t triangle_set_hash(const std::vector<GridPosition>& positions,
                                const std::vector<std::uint32_t>& indices);

}  // namespace atlaswire::bench
