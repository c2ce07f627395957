#include "render/gpu/image.h"

#include "base/assert.h"

#include <algorithm>

namespace atlaswire::render {
namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;
using Flag = vk::MemoryPropertyFlagBits;

struct UseInfo {
  vk::PipelineStageFlags2 stages;
  vk::AccessFlags2 access;
  vk::ImageLayout layout;
};

UseInfo info_of(ImageUse use) {
  switch (use) {
    case ImageUse::kNone:
      return {Stage::eNone, Access::eNone, vk::ImageLayout::eUndefined};
    case ImageUse::kColorTarget:
      return {Stage::eColorAttachmentOutput, Access::eColorAttachmentRead | Access::eColorAttachmentWrite,
              vk::ImageLayout::eColorAttachmentOptimal};
    case ImageUse::kDepthTarget:
      return {Stage::eEarlyFragmentTests | Stage::eLateFragmentTests,
              Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite,
              vk::ImageLayout::eDepthAttachmentOptimal};
    case ImageUse::kSampledInCompute:
      return {Stage::eComputeShader, Access::eShaderSampledRead, vk::ImageLayout::eShaderReadOnlyOptimal};
    case ImageUse::kSampledInFragment:
      return {Stage::eFragmentShader, Access::eShaderSampledRead, vk::ImageLayout::eShaderReadOnlyOptimal};
    case ImageUse::kStorageInCompute:
      return {Stage::eComputeShader, Access::eShaderStorageRead | Access::eShaderStorageWrite,
              vk::ImageLayout::eGeneral};
    case ImageUse::kStorageInFragment:
      return {Stage::eFragmentShader, Access::eShaderStorageRead | Access::eShaderStorageWrite,
              vk::ImageLayout::eGeneral};
    case ImageUse::kTransferSource:
      return {Stage::eTransfer, Access::eTransferRead, vk::ImageLayout::eTransferSrcOptimal};
    case ImageUse::kTransferTarget:
      return {Stage::eTransfer, Access::eTransferWrite, vk::ImageLayout::eTransferDstOptimal};
    case ImageUse::kHostRead:
      return {Stage::eHost, Access::eHostRead, vk::ImageLayout::eGeneral};
  }
  AW_ASSERT(false);
}

vk::ImageAspectFlags aspect_of(vk::Format format) {
  return format == vk::Format::eD32Sfloat || format == vk::Format::eD16Unorm
             ? vk::ImageAspectFlagBits::eDepth
             : vk::ImageAspectFlagBits::eColor;
}

vk::ImageCreateInfo create_info(const ImageSettings& s) {
  const bool linear = s.residence != Residence::kDevice;
  AW_ASSERT(!linear || (s.levels == 1 && s.layers == 1));
  return {.imageType = vk::ImageType::e2D,
          .format = s.format,
          .extent = {s.extent.width, s.extent.height, 1},
          .mipLevels = s.levels,
          .arrayLayers = s.layers,
          .samples = vk::SampleCountFlagBits::e1,
          .tiling = linear ? vk::ImageTiling::eLinear : vk::ImageTiling::eOptimal,
          .usage = s.usage};
}

vk::raii::DeviceMemory memory_for(const Device& device, const vk::raii::Image& image, Residence residence) {
  vk::MemoryPropertyFlags got;
  const auto needs = image.getMemoryRequirements();
  if (residence == Residence::kDevice) return device.allocate(needs, {}, Flag::eDeviceLocal, got);
  return device.allocate(needs, Flag::eHostVisible | Flag::eHostCoherent, Flag::eHostCached, got);
}

bool only_reads(ImageUse use) {
  return use == ImageUse::kSampledInCompute || use == ImageUse::kSampledInFragment ||
         use == ImageUse::kTransferSource || use == ImageUse::kHostRead;
}

}  // namespace

Image::Image(const Device& device, const ImageSettings& s)
    : extent_(s.extent),
      format_(s.format),
      aspect_(aspect_of(s.format)),
      levels_(s.levels),
      layers_(s.layers),
      image_(device.vk(), create_info(s)),
      memory_(memory_for(device, image_, s.residence)),
      view_(nullptr) {
  image_.bindMemory(*memory_, 0);
  constexpr auto kOnlyTransfer = vk::ImageUsageFlagBits::eTransferSrc | vk::ImageUsageFlagBits::eTransferDst;
  if (s.usage & ~kOnlyTransfer) {
    view_ = {device.vk(),
             {.image = *image_,
              .viewType = layers_ > 1 ? vk::ImageViewType::e2DArray : vk::ImageViewType::e2D,
              .format = format_,
              .subresourceRange = whole()}};
    device.set_name(view_, s.name + " view");
  }
  device.set_name(image_, s.name);
  if (s.residence != Residence::kDevice) {
    mapped_ = static_cast<std::byte*>(memory_.mapMemory(0, VK_WHOLE_SIZE));
    const auto layout = image_.getSubresourceLayout({.aspectMask = aspect_});
    mapped_ += layout.offset;
    row_pitch_ = layout.rowPitch;
  }
}

vk::ImageLayout Image::layout() const { return info_of(use_).layout; }

vk::ImageSubresourceRange Image::whole() const {
  return {.aspectMask = aspect_, .levelCount = levels_, .layerCount = layers_};
}

void Image::transition(const vk::raii::CommandBuffer& commands, ImageUse next, bool discard) {
  if (!discard && use_ == next && only_reads(next)) return;
  const UseInfo from = info_of(use_);
  const UseInfo to = info_of(next);
  const vk::ImageMemoryBarrier2 barrier{.srcStageMask = from.stages,
                                        .srcAccessMask = only_reads(use_) ? vk::AccessFlags2{} : from.access,
                                        .dstStageMask = to.stages,
                                        .dstAccessMask = to.access,
                                        .oldLayout = discard ? vk::ImageLayout::eUndefined : from.layout,
                                        .newLayout = to.layout,
                                        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                        .image = *image_,
                                        .subresourceRange = whole()};
  commands.pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier});
  use_ = next;
}

void use_image(const vk::raii::CommandBuffer& commands, Image& image, ImageUse next) {
  image.transition(commands, next, false);
}

void discard_image(const vk::raii::CommandBuffer& commands, Image& image, ImageUse next) {
  image.transition(commands, next, true);
}

vk::raii::Sampler make_sampler(const Device& device, const SamplerSettings& s) {
  const bool anisotropic = s.anisotropy > 1.0F && device.features().samplerAnisotropy == VK_TRUE;
  vk::raii::Sampler sampler(
      device.vk(),
      {.magFilter = s.filter,
       .minFilter = s.filter,
       .mipmapMode = s.mipmaps ? vk::SamplerMipmapMode::eLinear : vk::SamplerMipmapMode::eNearest,
       .addressModeU = s.address_u,
       .addressModeV = s.address_v,
       .addressModeW = vk::SamplerAddressMode::eClampToEdge,
       .anisotropyEnable = anisotropic,
       .maxAnisotropy = anisotropic ? std::min(s.anisotropy, device.limits().maxSamplerAnisotropy) : 1.0F,
       .compareEnable = s.depth_compare,
       .compareOp = vk::CompareOp::eGreaterOrEqual,
       .maxLod = s.mipmaps ? VK_LOD_CLAMP_NONE : 0.0F});
  device.set_name(sampler, s.name);
  return sampler;
}

}  // namespace atlaswire::render
