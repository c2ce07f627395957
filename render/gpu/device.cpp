#include "render/gpu/device.h"

#include "base/log.h"
#include "base/program.h"
#include "render/gpu/choose_device.h"

namespace atlaswire::render {
namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                          VkDebugUtilsMessageTypeFlagsEXT /*types*/,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* log) {
  const bool error = severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  spdlog::log(error ? spdlog::level::err : spdlog::level::warn, "Vulkan: {}", data->pMessage);
  static_cast<ValidationLog*>(log)->add(data->pMessage);
  return VK_FALSE;
}

vk::raii::DebugUtilsMessengerEXT make_messenger(const vk::raii::Instance& instance, bool validation,
                                                ValidationLog& log) {
  if (!validation) return nullptr;
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  return {instance,
          {.messageSeverity = Severity::eWarning | Severity::eError,
           .messageType = vk::DebugUtilsMessageTypeFlagBitsEXT::eValidation,
           .pfnUserCallback = on_message,
           .pUserData = &log}};
}

vk::raii::Device make_device(const vk::raii::PhysicalDevice& physical, std::uint32_t family) {
  const DeviceFeatures features(physical);
  const float priority = 1.0F;
  const vk::DeviceQueueCreateInfo queue{
      .queueFamilyIndex = family, .queueCount = 1, .pQueuePriorities = &priority};
  try {
    return {physical, {.pNext = &features.core, .queueCreateInfoCount = 1, .pQueueCreateInfos = &queue}};
  } catch (const vk::SystemError& error) {
    throw ProgramError(ExitCode::kNoDevice, "cannot open Vulkan device '" + describe(physical).name + "' (" +
                                                error.what() + "): set --device to another");
  }
}

}  // namespace

void ValidationLog::add(std::string message) {
  const std::lock_guard lock(mutex_);
  messages_.push_back(std::move(message));
}

std::vector<std::string> ValidationLog::messages() const {
  const std::lock_guard lock(mutex_);
  return messages_;
}

Device::Device(const DeviceSettings& settings)
    : context_(load_vulkan()),
      instance_(make_instance(context_, settings.validation)),
      messenger_(make_messenger(instance_, settings.validation, log_)),
      physical_(choose_device(instance_, settings.select)),
      properties_(physical_.getProperties()),
      memory_(physical_.getMemoryProperties()),
      features_(DeviceFeatures(physical_).core.features),
      name_(properties_.deviceName.data()),
      named_(settings.validation),
      queue_family_(universal_queue_family(physical_)),
      device_(make_device(physical_, queue_family_)),
      queue_(device_, queue_family_, 0),
      pipeline_cache_(device_, vk::PipelineCacheCreateInfo{}) {}

void Device::submit(const vk::SubmitInfo2& work) {
  const std::lock_guard lock(queue_mutex_);
  queue_.submit2(work);
}

vk::raii::DeviceMemory Device::allocate(const vk::MemoryRequirements& requirements,
                                        vk::MemoryPropertyFlags required, vk::MemoryPropertyFlags wanted,
                                        vk::MemoryPropertyFlags& got) const {
  for (const auto& needed : {required | wanted, required}) {
    for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
      const auto flags = memory_.memoryTypes[i].propertyFlags;
      if ((requirements.memoryTypeBits & (1U << i)) == 0 || (flags & needed) != needed) continue;
      got = flags;
      return {device_, {.allocationSize = requirements.size, .memoryTypeIndex = i}};
    }
  }
  throw ProgramError(ExitCode::kNoDevice, "Vulkan device '" + name_ + "' has no memory of the kind needed");
}

void Device::set_name(vk::ObjectType type, std::uint64_t handle, std::string_view object_name) const {
  if (!named_) return;
  const std::string text(object_name);
  device_.setDebugUtilsObjectNameEXT(
      {.objectType = type, .objectHandle = handle, .pObjectName = text.c_str()});
}

}  // namespace atlaswire::render
