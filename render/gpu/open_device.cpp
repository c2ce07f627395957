#include "render/gpu/open_device.h"

#include "base/program.h"
#include "render/gpu/choose_device.h"

namespace atlaswire::render {

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> found;
  try {
    const vk::raii::Context context = load_vulkan();
    const vk::raii::Instance instance = make_instance(context, false);
    for (const auto& device : vk::raii::PhysicalDevices(instance)) found.push_back(describe(device));
  } catch (const ProgramError&) {
    // No loader or no driver: the list is empty, and open_device() says what to install.
  }
  return found;
}

std::shared_ptr<Device> open_device(const DeviceSettings& settings) {
  return std::make_shared<Device>(settings);
}

const std::string& device_name(const Device& device) { return device.name(); }

std::vector<std::string> validation_messages(const Device& device) { return device.validation_messages(); }

}  // namespace atlaswire::render
