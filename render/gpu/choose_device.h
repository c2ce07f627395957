#pragma once

#include "render/gpu/device.h"

namespace atlaswire::render {

/// The features that a device is opened with: what we need, and what we use where it is there. Members
/// point at each other, so it stays where it was made.
struct DeviceFeatures {
  vk::PhysicalDeviceVulkan13Features v13;
  vk::PhysicalDeviceVulkan12Features v12;
  vk::PhysicalDeviceVulkan11Features v11;
  vk::PhysicalDeviceFeatures2 core;

  explicit DeviceFeatures(const vk::raii::PhysicalDevice& device);
  DeviceFeatures(const DeviceFeatures&) = delete;
  DeviceFeatures& operator=(const DeviceFeatures&) = delete;
};

/// The first thing that a device lacks; empty when usable.
std::string missing_in(const vk::raii::PhysicalDevice& device);
DeviceInfo describe(const vk::raii::PhysicalDevice& device);
/// The queue family that does graphics, compute and transfer, if any.
std::uint32_t universal_queue_family(const vk::raii::PhysicalDevice& device);

/// The device that DeviceSettings::select asks for. Throws ProgramError(kNoDevice).
vk::raii::PhysicalDevice choose_device(const vk::raii::Instance& instance, const std::string& select);

/// Loader and instance; throw ProgramError(kNoDevice) with the cure.
vk::raii::Context load_vulkan();
vk::raii::Instance make_instance(const vk::raii::Context& context, bool validation);

}  // namespace atlaswire::render
