#include "render/gpu/offscreen_target.h"

#include "render/gpu/barriers.h"
#include "render/gpu/pipeline.h"

#include <array>
#include <cstring>

namespace atlaswire::render {

OffscreenTarget::OffscreenTarget(const Device& device, const std::string& name, Extent2D extent)
    : color(device, {.name = name + " color",
                     .extent = extent,
                     .format = vk::Format::eR8G8B8A8Unorm,
                     .usage = vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eSampled |
                              vk::ImageUsageFlagBits::eTransferSrc}),
      depth(device, {.name = name + " depth",
                     .extent = extent,
                     .format = vk::Format::eD32Sfloat,
                     .usage = vk::ImageUsageFlagBits::eDepthStencilAttachment |
                              vk::ImageUsageFlagBits::eTransferSrc}),
      readback(device, {.name = name + " readback",
                        .size = extent.area() * 4,
                        .usage = vk::BufferUsageFlagBits::eTransferDst,
                        .residence = Residence::kReadback}) {}

namespace {

void begin_rendering(const vk::raii::CommandBuffer& commands, Extent2D extent,
                     const vk::RenderingAttachmentInfo& color, const vk::RenderingAttachmentInfo& depth) {
  commands.beginRendering({.renderArea = {.extent = {extent.width, extent.height}},
                           .layerCount = 1,
                           .colorAttachmentCount = 1,
                           .pColorAttachments = &color,
                           .pDepthAttachment = &depth});
  set_viewport(commands, extent);
}

}  // namespace

void OffscreenTarget::begin(const vk::raii::CommandBuffer& commands, const glm::vec3& background,
                            Depth depth_after) {
  discard_image(commands, color, ImageUse::kColorTarget);
  discard_image(commands, depth, ImageUse::kDepthTarget);
  const vk::RenderingAttachmentInfo color_info{
      .imageView = color.view(),
      .imageLayout = color.layout(),
      .loadOp = vk::AttachmentLoadOp::eClear,
      .storeOp = vk::AttachmentStoreOp::eStore,
      .clearValue = vk::ClearColorValue(std::array{background.x, background.y, background.z, 0.0F})};
  const vk::RenderingAttachmentInfo depth_info{.imageView = depth.view(),
                                               .imageLayout = depth.layout(),
                                               .loadOp = vk::AttachmentLoadOp::eClear,
                                               .storeOp = depth_after == Depth::kKept
                                                              ? vk::AttachmentStoreOp::eStore
                                                              : vk::AttachmentStoreOp::eDontCare,
                                               .clearValue = vk::ClearDepthStencilValue{.depth = 0.0F}};
  begin_rendering(commands, color.extent(), color_info, depth_info);
}

void OffscreenTarget::resume(const vk::raii::CommandBuffer& commands) {
  use_image(commands, color, ImageUse::kColorTarget);
  discard_image(commands, depth, ImageUse::kDepthTarget);
  const vk::RenderingAttachmentInfo color_info{.imageView = color.view(),
                                               .imageLayout = color.layout(),
                                               .loadOp = vk::AttachmentLoadOp::eLoad,
                                               .storeOp = vk::AttachmentStoreOp::eStore};
  const vk::RenderingAttachmentInfo depth_info{.imageView = depth.view(),
                                               .imageLayout = depth.layout(),
                                               .loadOp = vk::AttachmentLoadOp::eDontCare,
                                               .storeOp = vk::AttachmentStoreOp::eDontCare};
  begin_rendering(commands, color.extent(), color_info, depth_info);
}

void OffscreenTarget::record_readback(const vk::raii::CommandBuffer& commands) {
  use_image(commands, color, ImageUse::kTransferSource);
  const vk::BufferImageCopy region{.imageSubresource = {.aspectMask = color.aspect(), .layerCount = 1},
                                   .imageExtent = {color.extent().width, color.extent().height, 1}};
  commands.copyImageToBuffer(color.handle(), color.layout(), readback.handle(), region);
  writes_to_host(commands);
}

void OffscreenTarget::copy_to(Picture& picture) const {
  if (picture.extent != color.extent()) picture = Picture(color.extent());
  readback.invalidate();
  std::memcpy(picture.rgba.data(), readback.mapped().data(), picture.rgba.size());
}

void fit_target(std::unique_ptr<OffscreenTarget>& target, const Device& device, const std::string& name,
                Extent2D extent) {
  if (target != nullptr && target->color.extent() == extent) return;
  target = std::make_unique<OffscreenTarget>(device, name, extent);
}

void read_back(SubmitContext& context, OffscreenTarget& target, Picture& picture) {
  context.run([&](const vk::raii::CommandBuffer& commands) { target.record_readback(commands); });
  target.copy_to(picture);
}

}  // namespace atlaswire::render
