#pragma once

#include "base/grid.h"
#include "codec/meta_update.h"

#include <cstdint>
#include <vector>

namespace atlaswire::bench {

/// One update as codecs of whole meshes want it: the added patches as a mesh of its own, welded on the grid,
/// and patches named by their place among those shown, in order of arrival, so that no ids need be sent.
struct Increment {
  const codec::MetaUpdate* update = nullptr;
  std::vector<GridPosition> positions;  ///< each once, in order of first use
  std::vector<std::uint32_t> indices;   ///< 3 a triangle into `positions`; none with a corner twice
  std::vector<std::uint32_t> removed;   ///< places before the update, ascending
  std::vector<std::uint32_t> moved;     ///< places after the removals, beside `update->moved`
};

/// Follows a stream of updates; no codec's time is spent here.
class IncrementMaker {
 public:
  /// Borrows the update.
  Increment next(const codec::MetaUpdate& update);
  /// Triangles of the patches that an update adds, degenerate ones included.
  static std::uint32_t added_triangles(const codec::MetaUpdate& update);

 private:
  void take_out(const codec::MetaUpdate& update, Increment& increment);
  void weld(const codec::MetaUpdate& update, Increment& increment) const;

  std::vector<GridPosition> positions_;  ///< by VertexId
  std::vector<PatchId> shown_;           ///< in order of arrival
};

}  // namespace atlaswire::bench
