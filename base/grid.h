#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace atlaswire {

/// A vertex position on the scene's integer grid; each axis in [0, 2^bits).
using GridPosition = glm::u32vec3;

/// The one scene-wide grid that client replicas live on: cubic cells, so that one number bounds the error.
struct PositionGrid {
  glm::dvec3 origin{0.0};   ///< scene position of grid point (0,0,0), metres
  double step = 1e-3;       ///< metres between neighbouring grid points, > 0
  std::uint32_t bits = 16;  ///< per axis, 8..20

  /// The grid over a bounding box: step = longest side / (2^bits - 1). A zero box gets step 2^-20 m.
  static PositionGrid over(const glm::dvec3& low, const glm::dvec3& high, std::uint32_t bits);

  /// The fewest bits from 16 to 20 whose step over the box is at most 2 mm, below what a viewer at arm's
  /// length can see; 20 where none is.
  static std::uint32_t suited_bits(const glm::dvec3& low, const glm::dvec3& high);

  /// Nearest grid point, clamped to the grid.
  [[nodiscard]] GridPosition quantize(const glm::dvec3& position) const;
  [[nodiscard]] glm::dvec3 position(const GridPosition& p) const;
  /// Largest distance in metres between a point of the box and its grid point: sqrt(3)/2 * step.
  [[nodiscard]] double max_error() const;
};

}  // namespace atlaswire
