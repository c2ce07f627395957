#include "render/passes/move_staging.h"

#include "base/assert.h"
#include "render/gpu/barriers.h"

#include <cstring>

namespace atlaswire::render {

MoveStaging::MoveStaging(const Device& device, const char* name, std::size_t bytes)
    : buffer_(device, {.name = name,
                       .size = bytes,
                       .usage = vk::BufferUsageFlagBits::eTransferSrc,
                       .residence = Residence::kUpload}) {}

void MoveStaging::add(std::span<const std::byte> bytes, const Buffer& target, std::size_t offset) {
  if (bytes.empty()) return;
  AW_ASSERT(used_ + bytes.size() <= buffer_.size());
  std::memcpy(buffer_.mapped().data() + used_, bytes.data(), bytes.size());
  copies_.push_back({target.handle(), {used_, offset, bytes.size()}});
  used_ += bytes.size();
}

void MoveStaging::record(const vk::raii::CommandBuffer& commands) {
  if (copies_.empty()) return;
  buffer_.flush();
  shaders_to_transfer(commands);
  for (const Copy& copy : copies_) commands.copyBuffer(buffer_.handle(), copy.target, copy.region);
  transfer_to_shaders(commands);
  copies_.clear();
  used_ = 0;
}

}  // namespace atlaswire::render
