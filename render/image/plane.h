#pragma once

#include "base/units.h"

#include <vector>

namespace atlaswire::render {

/// One float per pixel, rows from the top.
struct Plane {
  Extent2D extent;
  std::vector<float> values;

  explicit Plane(Extent2D size) : extent(size), values(size.area()) {}
  [[nodiscard]] float* row(std::uint32_t y) { return values.data() + std::size_t{y} * extent.width; }
  [[nodiscard]] const float* row(std::uint32_t y) const {
    return values.data() + std::size_t{y} * extent.width;
  }
};

/// Each row filtered by an odd number of weights, the middle one at the output; border pixels repeat.
Plane filtered_along_rows(const Plane& in, const std::vector<float>& weights);

/// Each column likewise.
Plane filtered_along_columns(const Plane& in, const std::vector<float>& weights);

}  // namespace atlaswire::render
