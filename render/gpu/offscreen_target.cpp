#include "render/gpu/offscreen_target.h"

namespace atlaswire::render {

OffscreenTarget::OffscreenTarget(const Device& device, const std::string& name, Extent2D extent)
    : color(device,
            {.name = name + " color",
             .extent = extent,
             .format = vk::Format::eR8G8B8A8Unorm,
             .usage = vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eTransferSrc}),
      depth(device, {.name = name + " depth",
                     .extent = extent,
                     .format = vk::Format::eD32Sfloat,
                     .usage = vk::ImageUsageFlagBits::eDepthStencilAttachment}),
      readback(device, {.name = name + " readback",
                        .size = extent.area() * 4,
                        .usage = vk::BufferUsageFlagBits::eTransferDst,
                        .residence = Residence::kReadback}) {}

}  // namespace atlaswire::render
