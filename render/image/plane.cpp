#include "render/image/plane.h"

#include "base/assert.h"
#include "render/image/weighted_sum.h"

#include <algorithm>

namespace atlaswire::render {

Plane filtered_along_rows(const Plane& in, const std::vector<float>& weights) {
  AW_ASSERT(weights.size() % 2 == 1);
  Plane out(in.extent);
  const std::size_t radius = weights.size() / 2;
  std::vector<float> padded(in.extent.width + 2 * radius);
  const auto middle = padded.begin() + static_cast<std::ptrdiff_t>(radius);
  for (std::uint32_t y = 0; y < in.extent.height; ++y) {
    const float* row = in.row(y);
    std::fill(padded.begin(), middle, row[0]);
    const auto end = std::copy(row, row + in.extent.width, middle);
    std::fill(end, padded.end(), row[in.extent.width - 1]);
    weighted_sum_along(weights, padded.data(), in.extent.width, out.row(y));
  }
  return out;
}

Plane filtered_along_columns(const Plane& in, const std::vector<float>& weights) {
  AW_ASSERT(weights.size() % 2 == 1);
  Plane out(in.extent);
  const auto radius = static_cast<std::int64_t>(weights.size() / 2);
  std::vector<const float*> rows(weights.size());
  for (std::uint32_t y = 0; y < in.extent.height; ++y) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::int64_t from = std::int64_t{y} + static_cast<std::int64_t>(i) - radius;
      const std::int64_t last = std::int64_t{in.extent.height} - 1;
      rows[i] = in.row(static_cast<std::uint32_t>(std::clamp<std::int64_t>(from, 0, last)));
    }
    weighted_sum(weights, rows.data(), in.extent.width, out.row(y));
  }
  return out;
}

}  // namespace atlaswire::render
