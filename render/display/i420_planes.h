#pragma once

#include "base/units.h"

#include <cstdint>

namespace atlaswire::render {

/// Borrowed planes of a decoded picture, BT.709 full range; strides in octets. With coverage the luma of the
/// lower half is the coverage of the upper half (render/method.h).
struct I420Planes {
  Extent2D extent;
  const std::uint8_t* y = nullptr;
  const std::uint8_t* u = nullptr;
  const std::uint8_t* v = nullptr;
  std::uint32_t y_stride = 0;
  std::uint32_t uv_stride = 0;
};

}  // namespace atlaswire::render
