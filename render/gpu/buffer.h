#pragma once

#include "render/gpu/device.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace atlaswire::render {

/// Where a resource lives and who touches it.
enum class Residence : std::uint8_t {
  kDevice,    ///< the device only
  kUpload,    ///< host writes, device reads
  kReadback,  ///< device writes, host reads
};

/// What a buffer is to be; `size` in bytes, 0 is made 4.
struct BufferSettings {
  std::string name;
  std::size_t size = 0;
  vk::BufferUsageFlags usage;
  Residence residence = Residence::kDevice;
};

/// A buffer with its own memory; host-visible ones stay mapped.
class Buffer {
 public:
  Buffer(const Device& device, const BufferSettings& settings);

  [[nodiscard]] vk::Buffer handle() const { return *buffer_; }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// The mapped bytes as `T`s; empty for kDevice.
  template <class T = std::byte>
  [[nodiscard]] std::span<T> mapped() const {
    return {reinterpret_cast<T*>(mapped_), mapped_ == nullptr ? 0 : size_ / sizeof(T)};
  }
  /// After host writes, before the submit that reads them. Free on coherent memory.
  void flush() const;
  /// After the wait for device writes, before host reads. Free on coherent memory.
  void invalidate() const;

 private:
  std::size_t size_;
  vk::raii::Buffer buffer_;
  vk::MemoryPropertyFlags properties_;
  vk::raii::DeviceMemory memory_;
  const vk::raii::Device* device_;
  std::byte* mapped_ = nullptr;
};

}  // namespace atlaswire::render
