#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <glm/vec3.hpp>

namespace atlaswire::codec {

/// A grid position or a difference of two, in steps.
using GridOffset = glm::ivec3;

/// L1, in steps.
inline std::uint32_t grid_distance(const GridOffset& a, const GridOffset& b) {
  return static_cast<std::uint32_t>(std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z));
}

/// How far off each of several ways to foretell a position was of late: bit lengths of distances, those long
/// past fading as 1 - 1/Span a time.
template <std::size_t Ways, std::uint32_t Span>
class Contest {
 public:
  /// The way that was off the least, the first of equals.
  [[nodiscard]] std::size_t best() const {
    return static_cast<std::size_t>(std::ranges::min_element(off_) - off_.begin());
  }
  void note(std::size_t way, std::uint32_t distance) {
    off_[way] += 64 * static_cast<std::uint32_t>(std::bit_width(distance)) - off_[way] / Span;
  }

 private:
  std::array<std::uint32_t, Ways> off_{};
};

/// What each way says of one position.
template <std::size_t Ways, std::uint32_t Span>
struct Forecast {
  Contest<Ways, Span>* contest = nullptr;  ///< null: nothing is foretold
  std::array<GridOffset, Ways> positions{};

  [[nodiscard]] const GridOffset& best() const { return positions[contest->best()]; }
  void learn(const GridOffset& position) const {
    if (contest == nullptr) return;
    for (std::size_t way = 0; way < Ways; ++way) contest->note(way, grid_distance(position, positions[way]));
  }
};

}  // namespace atlaswire::codec
