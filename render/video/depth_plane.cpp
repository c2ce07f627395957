#include "render/video/depth_plane.h"

#include "base/assert.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace atlaswire::render {

double depth_plane_nearest(double nearest) { return std::exp2(std::floor(std::log2(nearest) * 4) / 4); }

void encode_depth_plane(std::span<const float> depth, double nearest, std::span<std::uint8_t> luma) {
  AW_ASSERT(depth.size() == luma.size());
  // Infinity over infinity: nothing was drawn at all.
  const auto scale = std::isinf(nearest) ? 0.0F : static_cast<float>(255 * nearest);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    luma[i] = static_cast<std::uint8_t>(std::min(scale / depth[i] + 0.5F, 255.0F));
  }
}

I420Planes upper_half(const I420Planes& picture) {
  I420Planes upper = picture;
  upper.extent.height /= 2;
  return upper;
}

void decode_depth_plane(const I420Planes& picture, double nearest, std::vector<float>& depth) {
  const Extent2D extent = upper_half(picture).extent;
  std::array<float, 256> distance_of{};
  distance_of[0] = std::numeric_limits<float>::infinity();
  for (std::size_t value = 1; value < distance_of.size(); ++value) {
    distance_of[value] = static_cast<float>(255 * nearest / static_cast<double>(value));
  }
  depth.clear();
  depth.reserve(extent.area());
  for (std::uint32_t row = extent.height; row < picture.extent.height; ++row) {
    const std::uint8_t* luma = picture.y + std::size_t{row} * picture.y_stride;
    for (std::uint32_t x = 0; x < extent.width; ++x) depth.push_back(distance_of[luma[x]]);
  }
}

}  // namespace atlaswire::render
