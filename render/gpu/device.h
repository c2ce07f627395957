#pragma once

#include "render/gpu/open_device.h"
#include "render/gpu/vk.h"

#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace atlaswire::render {

/// What the layers said: filled from the driver's threads.
class ValidationLog {
 public:
  void add(std::string message);
  [[nodiscard]] std::vector<std::string> messages() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> messages_;
};

/// An open Vulkan 1.3 device with one queue that does graphics, compute and transfer. Everything else in
/// render/ borrows it and must die before it. Creating objects is thread safe; the queue is guarded.
class Device {
 public:
  explicit Device(const DeviceSettings& settings);
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  [[nodiscard]] const vk::raii::Device& vk() const { return device_; }
  [[nodiscard]] const vk::raii::PhysicalDevice& physical() const { return physical_; }
  [[nodiscard]] const vk::PhysicalDeviceLimits& limits() const { return properties_.limits; }
  [[nodiscard]] const vk::PhysicalDeviceFeatures& features() const { return features_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// It runs on the CPU: cores are shared with encoding, and memory is all one.
  [[nodiscard]] bool is_cpu() const { return properties_.deviceType == vk::PhysicalDeviceType::eCpu; }
  [[nodiscard]] std::uint32_t queue_family() const { return queue_family_; }
  [[nodiscard]] const vk::raii::PipelineCache& pipeline_cache() const { return pipeline_cache_; }

  /// Submits to the queue, one caller at a time.
  void submit(const vk::SubmitInfo2& work);

  /// Memory for a resource: the first type that has all of `required` and, if any has, also `wanted`.
  [[nodiscard]] vk::raii::DeviceMemory allocate(const vk::MemoryRequirements& requirements,
                                                vk::MemoryPropertyFlags required,
                                                vk::MemoryPropertyFlags wanted,
                                                vk::MemoryPropertyFlags& got) const;

  /// Names an object for layers and debuggers; free of cost without them.
  template <class Handle>
  void set_name(const Handle& handle, std::string_view object_name) const {
    set_name(Handle::objectType,
             reinterpret_cast<std::uint64_t>(static_cast<typename Handle::CType>(*handle)), object_name);
  }

  [[nodiscard]] std::vector<std::string> validation_messages() const { return log_.messages(); }

 private:
  void set_name(vk::ObjectType type, std::uint64_t handle, std::string_view object_name) const;

  ValidationLog log_;
  vk::raii::Context context_;
  vk::raii::Instance instance_;
  vk::raii::DebugUtilsMessengerEXT messenger_;
  vk::raii::PhysicalDevice physical_;
  vk::PhysicalDeviceProperties properties_;
  vk::PhysicalDeviceMemoryProperties memory_;
  vk::PhysicalDeviceFeatures features_;
  std::string name_;
  bool named_;  ///< the debug-utils extension is on
  std::uint32_t queue_family_;
  vk::raii::Device device_;
  vk::raii::Queue queue_;
  vk::raii::PipelineCache pipeline_cache_;
  std::mutex queue_mutex_;
};

}  // namespace atlaswire::render
