#pragma once

#include <memory>
#include <string>
#include <vector>

namespace atlaswire::render {

class Device;

/// Which Vulkan device, and how it is watched.
struct DeviceSettings {
  /// "auto" (discrete GPU, then other GPUs, then CPU), an index into list_devices(), or part of a device's
  /// name in any case.
  std::string select = "auto";
  bool validation = false;  ///< the Khronos validation layer; its messages go to the log and are counted
};

/// A device as people see it in a list.
struct DeviceInfo {
  std::string name;
  std::string kind;     ///< "discrete GPU", "integrated GPU", "virtual GPU", "CPU", "other"
  std::string missing;  ///< empty: usable; else the first thing it lacks
};

/// Every Vulkan device of this machine, usable or not; empty without a loader or driver.
std::vector<DeviceInfo> list_devices();

/// Opens a device. Thread safe to share: queue submission is guarded. Throws ProgramError(kNoDevice) that
/// says what was found and what to do.
std::shared_ptr<Device> open_device(const DeviceSettings& settings);

/// The open device's name.
const std::string& device_name(const Device& device);

/// Warnings and errors that the validation layer reported so far, oldest first.
std::vector<std::string> validation_messages(const Device& device);

}  // namespace atlaswire::render
