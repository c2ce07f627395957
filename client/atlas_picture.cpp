#include "client/atlas_picture.h"

#include "base/assert.h"

#include <algorithm>
#include <cmath>

namespace atlaswire::client {
namespace {

std::uint8_t to_byte(float v) { return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0F, 255.0F))); }

}  // namespace

render::Picture atlas_picture(const codec::I420View& picture, Extent2D colors) {
  AW_ASSERT(colors.width <= picture.extent.width && colors.height <= picture.extent.height);
  render::Picture out(colors);
  for (std::uint32_t y = 0; y < colors.height; ++y) {
    const std::uint8_t* luma = picture.y + std::size_t{y} * picture.y_stride;
    const std::uint8_t* blue = picture.u + std::size_t{y / 2} * picture.uv_stride;
    const std::uint8_t* red = picture.v + std::size_t{y / 2} * picture.uv_stride;
    for (std::uint32_t x = 0; x < colors.width; ++x) {
      const float l = luma[x];
      const float b = static_cast<float>(blue[x / 2]) - 128.0F;
      const float r = static_cast<float>(red[x / 2]) - 128.0F;
      out.set(x, y,
              {to_byte(l + 1.5748F * r), to_byte(l - 0.187324F * b - 0.468124F * r), to_byte(l + 1.8556F * b),
               255});
    }
  }
  return out;
}

}  // namespace atlaswire::client
