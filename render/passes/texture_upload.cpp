#include "render/passes/texture_upload.h"

#include "base/assert.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace atlaswire::render {
namespace {

std::uint32_t level_count(Extent2D extent) {
  return static_cast<std::uint32_t>(std::bit_width(std::max(extent.width, extent.height)));
}

std::size_t sampler_index(const Texture& t) {
  return (t.repeat_u ? 1U : 0U) | (t.repeat_v ? 2U : 0U) | (t.nearest ? 4U : 0U);
}

void change_level(const vk::raii::CommandBuffer& commands, const Image& image, std::uint32_t level,
                  vk::ImageLayout from, vk::ImageLayout to) {
  const vk::ImageMemoryBarrier2 barrier{
      .srcStageMask = vk::PipelineStageFlagBits2::eTransfer,
      .srcAccessMask = vk::AccessFlagBits2::eTransferWrite,
      .dstStageMask = vk::PipelineStageFlagBits2::eTransfer,
      .dstAccessMask = vk::AccessFlagBits2::eTransferRead | vk::AccessFlagBits2::eTransferWrite,
      .oldLayout = from,
      .newLayout = to,
      .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .image = image.handle(),
      .subresourceRange = {.aspectMask = vk::ImageAspectFlagBits::eColor,
                           .baseMipLevel = level,
                           .levelCount = 1,
                           .layerCount = 1}};
  commands.pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier});
}

vk::Offset3D level_size(Extent2D extent, std::uint32_t level) {
  return {static_cast<std::int32_t>(std::max(extent.width >> level, 1U)),
          static_cast<std::int32_t>(std::max(extent.height >> level, 1U)), 1};
}

/// Each level from the one above it. The image is and stays a transfer target.
void blit_levels(const vk::raii::CommandBuffer& commands, const Image& image) {
  constexpr auto kColor = vk::ImageAspectFlagBits::eColor;
  for (std::uint32_t level = 1; level < image.levels(); ++level) {
    change_level(commands, image, level - 1, vk::ImageLayout::eTransferDstOptimal,
                 vk::ImageLayout::eTransferSrcOptimal);
    vk::ImageBlit region{.srcSubresource = {.aspectMask = kColor, .mipLevel = level - 1, .layerCount = 1},
                         .dstSubresource = {.aspectMask = kColor, .mipLevel = level, .layerCount = 1}};
    region.srcOffsets[1] = level_size(image.extent(), level - 1);
    region.dstOffsets[1] = level_size(image.extent(), level);
    commands.blitImage(image.handle(), vk::ImageLayout::eTransferSrcOptimal, image.handle(),
                       vk::ImageLayout::eTransferDstOptimal, region, vk::Filter::eLinear);
  }
  for (std::uint32_t level = 0; level + 1 < image.levels(); ++level) {
    change_level(commands, image, level, vk::ImageLayout::eTransferSrcOptimal,
                 vk::ImageLayout::eTransferDstOptimal);
  }
}

std::unique_ptr<Image> upload(SubmitContext& context, const Texture& texture) {
  AW_ASSERT(texture.rgba.size() == texture.extent.area() * 4);
  auto image = std::make_unique<Image>(
      context.device(),
      ImageSettings{.name = "texture " + texture.name,
                    .extent = texture.extent,
                    .format = texture.srgb ? vk::Format::eR8G8B8A8Srgb : vk::Format::eR8G8B8A8Unorm,
                    .usage = vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferSrc |
                             vk::ImageUsageFlagBits::eTransferDst,
                    .levels = level_count(texture.extent)});
  const Buffer staging(context.device(), {.name = "texture staging",
                                          .size = texture.rgba.size(),
                                          .usage = vk::BufferUsageFlagBits::eTransferSrc,
                                          .residence = Residence::kUpload});
  std::memcpy(staging.mapped().data(), texture.rgba.data(), texture.rgba.size());
  staging.flush();
  context.run([&](const vk::raii::CommandBuffer& commands) {
    use_image(commands, *image, ImageUse::kTransferTarget);
    const vk::BufferImageCopy region{
        .imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1},
        .imageExtent = {texture.extent.width, texture.extent.height, 1}};
    commands.copyBufferToImage(staging.handle(), image->handle(), vk::ImageLayout::eTransferDstOptimal,
                               region);
    blit_levels(commands, *image);
    use_image(commands, *image, ImageUse::kSampledInFragment);
  });
  return image;
}

}  // namespace

TextureSet::TextureSet(SubmitContext& context, const std::vector<Texture>& textures) {
  const Texture white{.name = "white", .extent = {1, 1}, .rgba = {255, 255, 255, 255}};
  for (std::size_t i = 0; i < 8; ++i) {
    const auto address = [](bool repeat) {
      return repeat ? vk::SamplerAddressMode::eRepeat : vk::SamplerAddressMode::eClampToEdge;
    };
    samplers_.push_back(
        make_sampler(context.device(), {.name = "texture sampler",
                                        .filter = (i & 4U) != 0 ? vk::Filter::eNearest : vk::Filter::eLinear,
                                        .mipmaps = true,
                                        .anisotropy = context.device().is_cpu() ? 1.0F : 8.0F,
                                        .address_u = address((i & 1U) != 0),
                                        .address_v = address((i & 2U) != 0)}));
  }
  for (const Texture& texture : textures) {
    images_.push_back(upload(context, texture));
    sampler_of_.push_back(sampler_index(texture));
  }
  images_.push_back(upload(context, white));
  sampler_of_.push_back(sampler_index(white));
}

const Image& TextureSet::image(std::int32_t texture) const {
  return texture == kNoTexture ? *images_.back() : *images_.at(static_cast<std::size_t>(texture));
}

const vk::raii::Sampler& TextureSet::sampler(std::int32_t texture) const {
  return samplers_[texture == kNoTexture ? sampler_of_.back()
                                         : sampler_of_.at(static_cast<std::size_t>(texture))];
}

}  // namespace atlaswire::render
