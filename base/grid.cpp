#include "base/grid.h"

#include "base/assert.h"

#include <algorithm>
#include <cmath>

namespace atlaswire {

PositionGrid PositionGrid::over(const glm::dvec3& low, const glm::dvec3& high, std::uint32_t bits) {
  AW_ASSERT(bits >= 8 && bits <= 20);
  const double side = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  PositionGrid grid;
  grid.origin = low;
  grid.bits = bits;
  grid.step = side > 0 ? side / static_cast<double>((1U << bits) - 1U) : 0x1.0p-20;
  return grid;
}

std::uint32_t PositionGrid::suited_bits(const glm::dvec3& low, const glm::dvec3& high) {
  constexpr double kStep = 2e-3;
  std::uint32_t bits = 16;
  while (bits < 20 && over(low, high, bits).step > kStep) ++bits;
  return bits;
}

GridPosition PositionGrid::quantize(const glm::dvec3& position) const {
  const double top = static_cast<double>((1U << bits) - 1U);
  GridPosition out;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = std::round((position[axis] - origin[axis]) / step);
    out[axis] = static_cast<std::uint32_t>(std::clamp(cells, 0.0, top));
  }
  return out;
}

glm::dvec3 PositionGrid::position(const GridPosition& p) const { return origin + glm::dvec3(p) * step; }

double PositionGrid::max_error() const { return 0.5 * std::sqrt(3.0) * step; }

}  // namespace atlaswire
