#include "render/gpu/buffer.h"

#include <algorithm>

namespace atlaswire::render {
namespace {

using Flag = vk::MemoryPropertyFlagBits;

vk::MemoryPropertyFlags required_by(Residence residence) {
  return residence == Residence::kDevice ? vk::MemoryPropertyFlags{} : Flag::eHostVisible;
}

vk::MemoryPropertyFlags wanted_by(Residence residence) {
  switch (residence) {
    case Residence::kUpload:
      return Flag::eHostCoherent;
    case Residence::kReadback:
      return Flag::eHostCached | Flag::eHostCoherent;
    default:
      return Flag::eDeviceLocal;
  }
}

}  // namespace

Buffer::Buffer(const Device& device, const BufferSettings& settings)
    : size_(std::max<std::size_t>(settings.size, 4)),
      buffer_(device.vk(), {.size = size_, .usage = settings.usage}),
      memory_(device.allocate(buffer_.getMemoryRequirements(), required_by(settings.residence),
                              wanted_by(settings.residence), properties_)),
      device_(&device.vk()) {
  buffer_.bindMemory(*memory_, 0);
  device.set_name(buffer_, settings.name);
  if (settings.residence != Residence::kDevice) {
    mapped_ = static_cast<std::byte*>(memory_.mapMemory(0, VK_WHOLE_SIZE));
  }
}

void Buffer::flush() const {
  if (mapped_ == nullptr || (properties_ & Flag::eHostCoherent)) return;
  device_->flushMappedMemoryRanges(vk::MappedMemoryRange{.memory = *memory_, .size = VK_WHOLE_SIZE});
}

void Buffer::invalidate() const {
  if (mapped_ == nullptr || (properties_ & Flag::eHostCoherent)) return;
  device_->invalidateMappedMemoryRanges(vk::MappedMemoryRange{.memory = *memory_, .size = VK_WHOLE_SIZE});
}

}  // namespace atlaswire::render
