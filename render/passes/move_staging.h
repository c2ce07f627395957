#pragma once

#include "render/gpu/buffer.h"

#include <cstddef>
#include <span>
#include <vector>

namespace atlaswire::render {

/// Brings what moved from the host to buffers of the device, through memory made once. Before anything is
/// added, what was recorded last must be over.
class MoveStaging {
 public:
  /// `bytes`: the most that is ever added between two recordings.
  MoveStaging(const Device& device, const char* name, std::size_t bytes);

  /// Notes that `bytes` go to `offset` of a buffer with usage eTransferDst.
  void add(std::span<const std::byte> bytes, const Buffer& target, std::size_t offset);
  /// Records the copies noted, before all that is drawn behind them. Nothing noted: records nothing.
  void record(const vk::raii::CommandBuffer& commands);

 private:
  struct Copy {
    vk::Buffer target;
    vk::BufferCopy region;
  };
  Buffer buffer_;
  std::size_t used_ = 0;
  std::vector<Copy> copies_;
};

}  // namespace atlaswire::render
