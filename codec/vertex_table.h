#pragma once

#include "base/grid.h"
#include "codec/flat_index.h"

#include <cstdint>
#include <vector>

namespace atlaswire::codec {

/// The vertices that both ends know, numbered as they came. A grid position is a vertex: none comes twice.
class VertexTable {
 public:
  static constexpr std::uint32_t kNone = FlatIndex::kNone;

  explicit VertexTable(std::uint64_t seed) : index_(seed) {}

  void clear() {
    positions_.clear();
    index_.clear();
  }
  /// The vertex at a position, or kNone. Coordinates must be below 2^21.
  [[nodiscard]] std::uint32_t find(const GridPosition& at) const { return index_.find(key_of(at)); }
  /// A new vertex, at a position that none has.
  std::uint32_t add(const GridPosition& at) {
    const auto vertex = static_cast<std::uint32_t>(positions_.size());
    positions_.push_back(at);
    index_.insert(key_of(at), vertex);
    return vertex;
  }
  [[nodiscard]] const GridPosition& position(std::uint32_t vertex) const { return positions_[vertex]; }
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(positions_.size()); }

 private:
  static std::uint64_t key_of(const GridPosition& at) {
    return std::uint64_t{at.x} | std::uint64_t{at.y} << 21U | std::uint64_t{at.z} << 42U;
  }

  std::vector<GridPosition> positions_;
  FlatIndex index_;
};

}  // namespace atlaswire::codec
