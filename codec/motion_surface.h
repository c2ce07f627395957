#pragma once

#include "base/assert.h"
#include "base/grid.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::codec {

/// What both ends of a motion stream know of the surface that moves: its vertices, numbered as they came,
/// each with its rest position and a few neighbours of smaller number. Both must be told the same in the same
/// order; neighbours are those of the first edges told. docs/PROTOCOL.md, "Surface".
class MotionSurface {
 public:
  static constexpr std::uint32_t kMostNeighbours = 4;

  void clear() { vertices_.clear(); }

  /// A vertex more; its number. Coordinates must be below 2^20.
  std::uint32_t add(const GridPosition& rest) {
    vertices_.push_back({.rest = rest});
    return size() - 1;
  }
  /// Makes two known vertices neighbours. An edge told twice, or from a vertex to itself, changes nothing.
  void connect(std::uint32_t a, std::uint32_t b) {
    AW_ASSERT(a < size() && b < size());
    if (a == b) return;
    Vertex& later = vertices_[std::max(a, b)];
    const std::uint32_t earlier = std::min(a, b);
    const std::span<const std::uint32_t> known = neighbours(std::max(a, b));
    if (known.size() == kMostNeighbours || std::ranges::find(known, earlier) != known.end()) return;
    later.neighbours[later.count++] = earlier;
  }
  /// Connects each corner of a polygon with the next, the last with the first.
  void connect_around(std::span<const std::uint32_t> corners) {
    for (std::size_t i = 0; i < corners.size(); ++i) connect(corners[i], corners[(i + 1) % corners.size()]);
  }

  [[nodiscard]] const GridPosition& rest(std::uint32_t vertex) const { return vertices_[vertex].rest; }
  [[nodiscard]] std::span<const std::uint32_t> neighbours(std::uint32_t vertex) const {
    return {vertices_[vertex].neighbours.data(), vertices_[vertex].count};
  }
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(vertices_.size()); }

 private:
  struct Vertex {
    GridPosition rest{0};
    std::array<std::uint32_t, kMostNeighbours> neighbours{};
    std::uint32_t count = 0;
  };
  std::vector<Vertex> vertices_;
};

}  // namespace atlaswire::codec
