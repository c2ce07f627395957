#pragma once

#include <compare>
#include <cstdint>

namespace atlaswire {

/// Where a patch's shading lies in the atlas ([SAS] 4.1): 2^width_log2 x 2^height_log2 texels, landscape
/// (width_log2 >= height_log2), top left corner at (x, y), y down.
struct Block {
  std::uint16_t x = 0;
  std::uint16_t y = 0;
  std::uint8_t width_log2 = 0;
  std::uint8_t height_log2 = 0;
  /// The patch's layout is mirrored at its diagonal (u and v change places), so that a patch that is
  /// taller than wide on screen still fits a landscape block.
  bool transposed = false;

  auto operator<=>(const Block&) const = default;
  [[nodiscard]] std::uint32_t width() const { return 1U << width_log2; }
  [[nodiscard]] std::uint32_t height() const { return 1U << height_log2; }
  [[nodiscard]] std::uint32_t area() const { return 1U << (width_log2 + height_log2); }
};

}  // namespace atlaswire
