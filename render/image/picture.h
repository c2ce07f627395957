#pragma once

#include "base/units.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace atlaswire::render {

/// A colour as it is stored: sRGB-encoded red, green, blue, and linear alpha.
using Rgba8 = std::array<std::uint8_t, 4>;

/// A picture on the host: RGBA8 rows from the top, no padding.
struct Picture {
  Extent2D extent;
  std::vector<std::uint8_t> rgba;  ///< extent.area() * 4 bytes

  Picture() = default;
  explicit Picture(Extent2D size, Rgba8 fill = {0, 0, 0, 255});

  bool operator==(const Picture&) const = default;
  [[nodiscard]] bool empty() const { return extent.area() == 0; }
  /// The pixel at column x < width, row y < height.
  [[nodiscard]] Rgba8 at(std::uint32_t x, std::uint32_t y) const {
    const std::uint8_t* p = &rgba[offset(x, y)];
    return {p[0], p[1], p[2], p[3]};
  }
  void set(std::uint32_t x, std::uint32_t y, Rgba8 colour) {
    for (std::size_t c = 0; c < 4; ++c) rgba[offset(x, y) + c] = colour[c];
  }

 private:
  [[nodiscard]] std::size_t offset(std::uint32_t x, std::uint32_t y) const {
    return 4 * (std::size_t{y} * extent.width + x);
  }
};

inline Picture::Picture(Extent2D size, Rgba8 fill) : extent(size), rgba(4 * size.area()) {
  for (std::size_t i = 0; i < rgba.size(); ++i) rgba[i] = fill[i % 4];
}

}  // namespace atlaswire::render
