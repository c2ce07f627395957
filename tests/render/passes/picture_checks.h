#pragma once

#include "render/gpu/barriers.h"
#include "render/gpu/image.h"
#include "render/gpu/submit_context.h"
#include "render/image/picture.h"
#include "render/passes/tonemap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace atlaswire::render::test {

/// An RGBA8 device image on the host; it must have been made for transfer.
inline Picture read_image(Device& device, Image& image) {
  SubmitContext context(device, "test readback", 1);
  const Buffer buffer(device, {.name = "test readback",
                               .size = image.extent().area() * 4,
                               .usage = vk::BufferUsageFlagBits::eTransferDst,
                               .residence = Residence::kReadback});
  context.run([&](const vk::raii::CommandBuffer& commands) {
    use_image(commands, image, ImageUse::kTransferSource);
    const vk::BufferImageCopy region{
        .imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1},
        .imageExtent = {image.extent().width, image.extent().height, 1}};
    commands.copyImageToBuffer(image.handle(), image.layout(), buffer.handle(), region);
    writes_to_host(commands);
  });
  buffer.invalidate();
  Picture picture(image.extent());
  std::memcpy(picture.rgba.data(), buffer.mapped().data(), picture.rgba.size());
  return picture;
}

/// What a pixel of this radiance must hold.
inline Rgba8 displayed(const glm::vec3& radiance, std::uint8_t alpha = 255) {
  const glm::vec3 c = display_color(radiance, 1.0F);
  const auto octet = [](float v) { return static_cast<std::uint8_t>(std::lround(v * 255.0F)); };
  return {octet(c.x), octet(c.y), octet(c.z), alpha};
}

/// Largest difference of any channel.
inline int difference(const Rgba8& a, const Rgba8& b) {
  int most = 0;
  for (std::size_t i = 0; i < 4; ++i) most = std::max(most, std::abs(int{a[i]} - int{b[i]}));
  return most;
}

/// EXPECT_NEAR over the channels of a pixel.
inline void expect_pixel(const Picture& picture, std::uint32_t x, std::uint32_t y, const Rgba8& expected,
                         int tolerance) {
  const Rgba8 got = picture.at(x, y);
  EXPECT_LE(difference(got, expected), tolerance)
      << "at " << x << "," << y << ": got " << int{got[0]} << " " << int{got[1]} << " " << int{got[2]} << " "
      << int{got[3]} << ", expected " << int{expected[0]} << " " << int{expected[1]} << " "
      << int{expected[2]} << " " << int{expected[3]};
}

}  // namespace atlaswire::render::test
