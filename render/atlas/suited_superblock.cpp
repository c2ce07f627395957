#include "render/atlas/allocator.h"

#include <algorithm>
#include <bit>

namespace atlaswire::render {

std::uint32_t suited_superblock_log2(Extent2D atlas) {
  constexpr std::uint32_t kSmallest = 5;
  constexpr std::uint32_t kLargest = 8;
  // log2 of an eighth of the side of a square of this area, rounded down.
  const auto area_log2 = static_cast<std::uint32_t>(std::bit_width(atlas.area())) - 1;
  const std::uint32_t eighth = std::max(area_log2 / 2, 3U) - 3;
  const auto divides = static_cast<std::uint32_t>(std::countr_zero(atlas.width | atlas.height));
  return std::max(kSmallest, std::min({eighth, kLargest, divides}));
}

std::uint32_t suited_min_block_log2(Extent2D atlas, std::uint32_t patch_count) {
  return atlas.area() < patch_count ? 0 : 1;
}

}  // namespace atlaswire::render
