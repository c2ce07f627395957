#include "render/gpu/choose_device.h"

#include "base/program.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

namespace atlaswire::render {
namespace {

constexpr const char* kCure = "install mesa-vulkan-drivers or set --device";
constexpr const char* kLayer = "VK_LAYER_KHRONOS_validation";

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

const char* kind_of(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return "discrete GPU";
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return "integrated GPU";
    case vk::PhysicalDeviceType::eVirtualGpu:
      return "virtual GPU";
    case vk::PhysicalDeviceType::eCpu:
      return "CPU";
    default:
      return "other";
  }
}

/// Smaller is better.
int rank(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return 0;
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return 1;
    case vk::PhysicalDeviceType::eVirtualGpu:
      return 2;
    case vk::PhysicalDeviceType::eOther:
      return 3;
    default:
      return 4;
  }
}

std::string list_for_people(const std::vector<vk::raii::PhysicalDevice>& devices) {
  std::string text;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo info = describe(devices[i]);
    text += (i == 0 ? "" : "; ") + std::to_string(i) + ": " + info.name + " (" + info.kind + ")";
    if (!info.missing.empty()) text += " lacks " + info.missing;
  }
  return text;
}

[[noreturn]] void refuse(const std::string& what) { throw ProgramError(ExitCode::kNoDevice, what); }

const vk::raii::PhysicalDevice* best_of(const std::vector<vk::raii::PhysicalDevice>& devices) {
  const vk::raii::PhysicalDevice* best = nullptr;
  for (const auto& device : devices) {
    if (!missing_in(device).empty()) continue;
    if (best == nullptr || rank(device.getProperties().deviceType) < rank(best->getProperties().deviceType)) {
      best = &device;
    }
  }
  return best;
}

const vk::raii::PhysicalDevice* named(const std::vector<vk::raii::PhysicalDevice>& devices,
                                      const std::string& select) {
  std::size_t index = 0;
  const char* const end = select.data() + select.size();
  if (const auto parsed = std::from_chars(select.data(), end, index);
      parsed.ec == std::errc{} && parsed.ptr == end) {
    return index < devices.size() ? &devices[index] : nullptr;
  }
  for (const auto& device : devices) {
    if (lower(describe(device).name).find(lower(select)) != std::string::npos) return &device;
  }
  return nullptr;
}

bool has_layer(const vk::raii::Context& context) {
  return std::ranges::any_of(context.enumerateInstanceLayerProperties(), [](const auto& layer) {
    return std::string_view(layer.layerName.data()) == kLayer;
  });
}

}  // namespace

DeviceFeatures::DeviceFeatures(const vk::raii::PhysicalDevice& device) {
  const auto have = device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan11Features,
                                        vk::PhysicalDeviceVulkan12Features>();
  const auto& has = have.get<vk::PhysicalDeviceFeatures2>().features;
  const auto& has11 = have.get<vk::PhysicalDeviceVulkan11Features>();
  const auto& has12 = have.get<vk::PhysicalDeviceVulkan12Features>();
  v13 = vk::PhysicalDeviceVulkan13Features{.shaderDemoteToHelperInvocation = true,
                                           .shaderTerminateInvocation = true,
                                           .synchronization2 = true,
                                           .dynamicRendering = true,
                                           .maintenance4 = true};
  v12 = vk::PhysicalDeviceVulkan12Features{.pNext = &v13,
                                           .drawIndirectCount = has12.drawIndirectCount,
                                           .storageBuffer8BitAccess = has12.storageBuffer8BitAccess,
                                           .shaderInt8 = has12.shaderInt8,
                                           .scalarBlockLayout = true,
                                           .hostQueryReset = has12.hostQueryReset,
                                           .timelineSemaphore = true};
  v11 = vk::PhysicalDeviceVulkan11Features{.pNext = &v12, .shaderDrawParameters = has11.shaderDrawParameters};
  core = vk::PhysicalDeviceFeatures2{
      .pNext = &v11,
      .features = {.independentBlend = has.independentBlend,
                   .multiDrawIndirect = true,
                   .depthClamp = has.depthClamp,
                   .samplerAnisotropy = has.samplerAnisotropy,
                   .occlusionQueryPrecise = has.occlusionQueryPrecise,
                   .vertexPipelineStoresAndAtomics = has.vertexPipelineStoresAndAtomics,
                   .fragmentStoresAndAtomics = true,
                   .shaderStorageImageExtendedFormats = has.shaderStorageImageExtendedFormats}};
}

std::uint32_t universal_queue_family(const vk::raii::PhysicalDevice& device) {
  constexpr auto kAll = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
  const auto families = device.getQueueFamilyProperties();
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if ((families[i].queueFlags & kAll) == kAll) return i;
  }
  return VK_QUEUE_FAMILY_IGNORED;
}

std::string missing_in(const vk::raii::PhysicalDevice& device) {
  if (device.getProperties().apiVersion < VK_API_VERSION_1_3) return "Vulkan 1.3";
  const auto have = device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                                        vk::PhysicalDeviceVulkan13Features>();
  const auto& core = have.get<vk::PhysicalDeviceFeatures2>().features;
  const auto& v12 = have.get<vk::PhysicalDeviceVulkan12Features>();
  const auto& v13 = have.get<vk::PhysicalDeviceVulkan13Features>();
  const std::array<std::pair<vk::Bool32, const char*>, 8> needed{{
      {core.multiDrawIndirect, "multiDrawIndirect"},
      {core.fragmentStoresAndAtomics, "fragmentStoresAndAtomics"},
      {v12.scalarBlockLayout, "scalarBlockLayout"},
      {v12.timelineSemaphore, "timelineSemaphore"},
      {v13.dynamicRendering, "dynamicRendering"},
      {v13.synchronization2, "synchronization2"},
      {v13.maintenance4, "maintenance4"},
      {universal_queue_family(device) != VK_QUEUE_FAMILY_IGNORED, "a graphics and compute queue"},
  }};
  for (const auto& [present, name] : needed) {
    if (present == VK_FALSE) return name;
  }
  return {};
}

DeviceInfo describe(const vk::raii::PhysicalDevice& device) {
  const auto properties = device.getProperties();
  return {.name = properties.deviceName.data(),
          .kind = kind_of(properties.deviceType),
          .missing = missing_in(device)};
}

vk::raii::PhysicalDevice choose_device(const vk::raii::Instance& instance, const std::string& select) {
  const vk::raii::PhysicalDevices devices(instance);
  if (devices.empty()) refuse(std::string("no Vulkan device: ") + kCure);
  const bool automatic = select.empty() || select == "auto";
  const vk::raii::PhysicalDevice* chosen = automatic ? best_of(devices) : named(devices, select);
  if (chosen == nullptr) {
    refuse((automatic ? "no usable Vulkan device" : "no Vulkan device matches '" + select + "'") +
           " (found " + list_for_people(devices) + "): " + kCure);
  }
  if (const std::string missing = missing_in(*chosen); !missing.empty()) {
    refuse("Vulkan device '" + describe(*chosen).name + "' lacks " + missing + " (found " +
           list_for_people(devices) + "): " + kCure);
  }
  return *chosen;
}

vk::raii::Context load_vulkan() {
  try {
    return vk::raii::Context();
  } catch (const std::runtime_error&) {
    refuse(std::string("no Vulkan loader (libvulkan1): ") + kCure);
  }
}

vk::raii::Instance make_instance(const vk::raii::Context& context, bool validation) {
  if (validation && !has_layer(context)) {
    refuse("no Vulkan validation layer: install vulkan-validationlayers or turn validation off");
  }
  const vk::ApplicationInfo application{
      .pApplicationName = "atlaswire", .pEngineName = "atlaswire", .apiVersion = VK_API_VERSION_1_3};
  const std::array extensions{VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
  const std::array enabled{vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
  const vk::ValidationFeaturesEXT features{.enabledValidationFeatureCount = enabled.size(),
                                           .pEnabledValidationFeatures = enabled.data()};
  vk::InstanceCreateInfo info{.pApplicationInfo = &application};
  if (validation) {
    info.pNext = &features;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kLayer;
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
  }
  try {
    return {context, info};
  } catch (const vk::SystemError& error) {
    refuse(std::string("no Vulkan driver (") + error.what() + "): " + kCure);
  }
}

}  // namespace atlaswire::render
