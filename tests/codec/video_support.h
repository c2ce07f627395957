#pragma once

#include "codec/video.h"

#include <cstdint>
#include <vector>

namespace atlaswire::codec {

/// A picture that owns its planes, for tests.
struct TestPicture {
  Extent2D extent;
  std::vector<std::uint8_t> y;
  std::vector<std::uint8_t> u;
  std::vector<std::uint8_t> v;

  [[nodiscard]] I420View view() const {
    return {extent, y.data(), u.data(), v.data(), extent.width, extent.width / 2};
  }
};

/// What a shading atlas looks like to a codec: square tiles of textures and gradients without relation to
/// their neighbours, each brightening a little from frame to frame, one in sixteen replaced.
TestPicture atlas_picture(Extent2D extent, std::uint32_t frame, std::uint64_t seed = 1);

/// Peak signal-to-noise ratio of the luma planes, decibels; 99 when they are equal.
double luma_psnr(const I420View& a, const I420View& b);

}  // namespace atlaswire::codec
