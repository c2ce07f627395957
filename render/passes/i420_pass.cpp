#include "render/passes/i420_pass.h"

#include "base/assert.h"
#include "base/program.h"
#include "render/gpu/barriers.h"
#include "shaders/shaders.h"

#include <algorithm>
#include <string>

namespace atlaswire::render {
namespace {

struct PictureConstants {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

Extent2D checked(Extent2D extent) {
  if (extent.width % 8 != 0 || extent.height % 2 != 0 || extent.area() == 0) {
    throw ProgramError(ExitCode::kUsage, "a picture of " + std::to_string(extent.width) + "x" +
                                             std::to_string(extent.height) +
                                             " cannot be converted: choose a width that is a multiple of 8 "
                                             "and an even height");
  }
  return extent;
}

std::vector<Buffer> make_planes(const Device& device, Extent2D picture, std::uint32_t slots) {
  std::vector<Buffer> planes;
  for (std::uint32_t i = 0; i < slots; ++i) {
    planes.emplace_back(device, BufferSettings{.name = "I420 planes",
                                               .size = picture.area() * 3 / 2,
                                               .usage = vk::BufferUsageFlagBits::eStorageBuffer,
                                               .residence = Residence::kReadback});
    // The lower half's chroma stays neutral for good.
    std::ranges::fill(planes.back().mapped(), std::byte{128});
    planes.back().flush();
  }
  return planes;
}

}  // namespace

I420Pass::I420Pass(const Device& device, const Image& source, LowerHalf lower, std::uint32_t slots)
    : colors_(checked(source.extent())),
      lower_(lower),
      sampler_(make_sampler(device, {.name = "I420 source", .filter = vk::Filter::eNearest})),
      layout_(device, "I420",
              {{0, vk::DescriptorType::eCombinedImageSampler}, {1, vk::DescriptorType::eStorageBuffer}}),
      pipeline_(device, ComputeSettings{.name = "I420",
                                        .shader = shaders::i420_comp,
                                        .layouts = {layout_.handle()},
                                        .push_constant_bytes = sizeof(PictureConstants),
                                        .specialization = {{0, static_cast<std::uint32_t>(lower)}}}),
      planes_(make_planes(device, picture_extent(), slots)),
      sets_(device, "I420", layout_, slots) {
  for (std::uint32_t i = 0; i < slots; ++i) {
    sets_.write(i, 0, source, sampler_);
    sets_.write(i, 1, planes_[i]);
  }
}

void I420Pass::record(const vk::raii::CommandBuffer& commands, std::uint32_t slot) const {
  pipeline_.bind(commands, {sets_.handle(slot)});
  pipeline_.push(commands, PictureConstants{colors_.width, colors_.height});
  commands.dispatch(group_count(colors_.width / 8, 8), group_count(colors_.height / 2, 8), 1);
  writes_to_host(commands);
}

I420Picture I420Pass::picture(std::uint32_t slot) const {
  planes_[slot].invalidate();
  const Extent2D extent = picture_extent();
  const std::uint8_t* y = planes_[slot].mapped<std::uint8_t>().data();
  const std::uint8_t* u = y + extent.area();
  return {.extent = extent, .y = y, .u = u, .v = u + extent.area() / 4};
}

std::span<std::uint8_t> I420Pass::lower_luma(std::uint32_t slot) const {
  AW_ASSERT(lower_ == LowerHalf::kFromHost);
  return planes_[slot].mapped<std::uint8_t>().subspan(colors_.area(), colors_.area());
}

Extent2D I420Pass::picture_extent() const {
  return {colors_.width, lower_ == LowerHalf::kNone ? colors_.height : colors_.height * 2};
}

}  // namespace atlaswire::render
