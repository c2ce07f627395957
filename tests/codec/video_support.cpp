#include "tests/codec/video_support.h"

#include "base/random.h"

#include <algorithm>
#include <cmath>

namespace atlaswire::codec {

namespace {

struct Tile {
  int base;
  int slope_x;
  int slope_y;
  int grain;
  int drift;
};

Tile draw_tile(Random& random) {
  const auto below = [&](std::uint64_t bound) { return static_cast<int>(random.below(bound)); };
  return {.base = 40 + below(160),
          .slope_x = below(9) - 4,
          .slope_y = below(9) - 4,
          .grain = below(24),
          .drift = below(3) - 1};
}

std::uint8_t clamp_octet(int v) { return static_cast<std::uint8_t>(std::clamp(v, 0, 255)); }

}  // namespace

TestPicture atlas_picture(Extent2D extent, std::uint32_t frame, std::uint64_t seed) {
  constexpr std::uint32_t kTile = 32;
  TestPicture out;
  out.extent = extent;
  out.y.resize(extent.area());
  out.u.assign(extent.area() / 4, 128);
  out.v.assign(extent.area() / 4, 128);
  const std::uint32_t columns = (extent.width + kTile - 1) / kTile;
  for (std::uint32_t tile_y = 0; tile_y < extent.height; tile_y += kTile) {
    for (std::uint32_t tile_x = 0; tile_x < extent.width; tile_x += kTile) {
      const std::uint32_t index = tile_y / kTile * columns + tile_x / kTile;
      const std::uint32_t born = (frame + index % 16) / 16;  // which tenant of the tile this is
      Random random(seed * 1'000'003 + std::uint64_t{index} * 977 + born);
      const Tile tile = draw_tile(random);
      const int light = tile.drift * static_cast<int>(frame % 16);
      for (std::uint32_t y = tile_y; y < std::min(tile_y + kTile, extent.height); ++y) {
        std::uint64_t noise = random.bits();
        for (std::uint32_t x = tile_x; x < std::min(tile_x + kTile, extent.width); ++x) {
          const int dx = static_cast<int>(x - tile_x);
          const int dy = static_cast<int>(y - tile_y);
          const int speck = tile.grain * static_cast<int>(noise & 3U) / 3;
          noise >>= 2U;
          const std::size_t at = std::size_t{y} * extent.width + x;
          out.y[at] = clamp_octet(tile.base + tile.slope_x * dx + tile.slope_y * dy + speck + light);
          const std::size_t chroma = std::size_t{y / 2} * (extent.width / 2) + x / 2;
          out.u[chroma] = clamp_octet(128 + tile.slope_x * 8);
          out.v[chroma] = clamp_octet(128 + tile.slope_y * 8);
        }
      }
    }
  }
  return out;
}

double luma_psnr(const I420View& a, const I420View& b) {
  double sum = 0;
  for (std::uint32_t y = 0; y < a.extent.height; ++y) {
    for (std::uint32_t x = 0; x < a.extent.width; ++x) {
      const int d = int{a.y[std::size_t{y} * a.y_stride + x]} - int{b.y[std::size_t{y} * b.y_stride + x]};
      sum += static_cast<double>(d) * d;
    }
  }
  const double mean = sum / static_cast<double>(a.extent.area());
  return mean > 0 ? 10 * std::log10(255.0 * 255.0 / mean) : 99.0;
}

}  // namespace atlaswire::codec
