#include "render/display/atlas_texture.h"

#include "base/assert.h"
#include "base/program.h"
#include "render/gpu/barriers.h"
#include "shaders/shaders.h"

#include <cstring>
#include <string>

namespace atlaswire::render {
namespace {

struct PictureConstants {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

Extent2D checked(Extent2D colors) {
  if (colors.width % 8 != 0 || colors.height % 2 != 0 || colors.area() == 0) {
    throw ProgramError(ExitCode::kPeerLost, "the server announced an atlas of " +
                                                std::to_string(colors.width) + "x" +
                                                std::to_string(colors.height) +
                                                ": its width must be a multiple of 8 and its height even");
  }
  return colors;
}

void copy_rows(const std::uint8_t* from, std::uint32_t stride, std::byte* to, std::uint32_t width,
               std::uint32_t height) {
  if (stride == width) {
    std::memcpy(to, from, std::size_t{width} * height);
    return;
  }
  for (std::uint32_t row = 0; row < height; ++row) {
    std::memcpy(to + std::size_t{row} * width, from + std::size_t{row} * stride, width);
  }
}

}  // namespace

AtlasTexture::Slot::Slot(const Device& device, Extent2D colors, Extent2D picture)
    : planes(device, {.name = "decoded planes",
                      .size = picture.area() * 3 / 2,
                      .usage = vk::BufferUsageFlagBits::eStorageBuffer,
                      .residence = Residence::kUpload}),
      texels(device,
             {.name = "client atlas texels",
              .size = colors.area() * 4,
              .usage = vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferSrc}),
      image(device, {.name = "client atlas",
                     .extent = colors,
                     .format = vk::Format::eR8G8B8A8Unorm,
                     .usage = vk::ImageUsageFlagBits::eTransferDst | vk::ImageUsageFlagBits::eSampled}) {}

AtlasTexture::AtlasTexture(Device& device, Extent2D colors, bool coverage, std::uint32_t slots)
    : colors_(checked(colors)),
      coverage_(coverage),
      layout_(device, "client atlas",
              {{0, vk::DescriptorType::eStorageBuffer}, {1, vk::DescriptorType::eStorageBuffer}}),
      pipeline_(device, ComputeSettings{.name = "atlas from I420",
                                        .shader = shaders::atlas_from_i420_comp,
                                        .layouts = {layout_.handle()},
                                        .push_constant_bytes = sizeof(PictureConstants),
                                        .specialization = {{0, coverage ? 1U : 0U}}}),
      sets_(device, "client atlas", layout_, slots),
      context_(device, "atlas upload", slots) {
  AW_ASSERT(slots >= 2);
  for (std::uint32_t i = 0; i < slots; ++i) {
    slots_.push_back(std::make_unique<Slot>(device, colors_, picture_extent()));
    sets_.write(i, 0, slots_[i]->planes);
    sets_.write(i, 1, slots_[i]->texels);
  }
}

Extent2D AtlasTexture::picture_extent() const {
  return {colors_.width, coverage_ ? colors_.height * 2 : colors_.height};
}

void AtlasTexture::copy_planes(const I420Planes& picture, const Buffer& to) const {
  const Extent2D e = picture.extent;
  std::byte* at = to.mapped().data();
  copy_rows(picture.y, picture.y_stride, at, e.width, e.height);
  at += e.area();
  copy_rows(picture.u, picture.uv_stride, at, e.width / 2, e.height / 2);
  at += e.area() / 4;
  copy_rows(picture.v, picture.uv_stride, at, e.width / 2, e.height / 2);
  to.flush();
}

std::uint32_t AtlasTexture::upload(const I420Planes& picture) {
  AW_ASSERT(picture.extent == picture_extent());
  const std::uint32_t index = next_;
  next_ = (next_ + 1) % slots();
  Slot& slot = *slots_[index];
  // Command buffers rotate with the slots: once begin() returns, the slot's last upload is over.
  const vk::raii::CommandBuffer& commands = context_.begin();
  copy_planes(picture, slot.planes);
  pipeline_.bind(commands, {sets_.handle(index)});
  pipeline_.push(commands, PictureConstants{colors_.width, colors_.height});
  commands.dispatch(group_count(colors_.width / 8, 8), group_count(colors_.height / 2, 8), 1);
  shaders_to_transfer(commands);
  use_image(commands, slot.image, ImageUse::kTransferTarget);
  const vk::BufferImageCopy region{
      .imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1},
      .imageExtent = {colors_.width, colors_.height, 1}};
  commands.copyBufferToImage(slot.texels.handle(), slot.image.handle(), slot.image.layout(), region);
  use_image(commands, slot.image, ImageUse::kSampledInFragment);
  context_.submit();
  return index;
}

}  // namespace atlaswire::render
