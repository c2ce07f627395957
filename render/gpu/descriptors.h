#pragma once

#include "render/gpu/image.h"

#include <cstdint>
#include <string>
#include <vector>

namespace atlaswire::render {

/// One binding of a set.
struct Binding {
  std::uint32_t binding = 0;
  vk::DescriptorType type = vk::DescriptorType::eStorageBuffer;
  vk::ShaderStageFlags stages = vk::ShaderStageFlagBits::eCompute;
  std::uint32_t count = 1;
};

/// The shape of descriptor sets.
class DescriptorLayout {
 public:
  DescriptorLayout(const Device& device, const std::string& name, std::vector<Binding> bindings);
  [[nodiscard]] vk::DescriptorSetLayout handle() const { return *layout_; }
  [[nodiscard]] const std::vector<Binding>& bindings() const { return bindings_; }

 private:
  std::vector<Binding> bindings_;
  vk::raii::DescriptorSetLayout layout_;
};

/// `count` sets of one layout from one pool. Write them before use and never while work that uses them is
/// pending.
class DescriptorSets {
 public:
  DescriptorSets(const Device& device, const std::string& name, const DescriptorLayout& layout,
                 std::uint32_t count = 1);

  [[nodiscard]] vk::DescriptorSet handle(std::uint32_t set = 0) const { return *sets_[set]; }
  /// A whole buffer.
  void write(std::uint32_t set, std::uint32_t binding, const Buffer& buffer);
  /// A storage image, in layout eGeneral.
  void write(std::uint32_t set, std::uint32_t binding, const Image& image);
  /// A combined image sampler, in layout eShaderReadOnlyOptimal.
  void write(std::uint32_t set, std::uint32_t binding, const Image& image, const vk::raii::Sampler& sampler,
             std::uint32_t element = 0);

 private:
  [[nodiscard]] vk::DescriptorType type_of(std::uint32_t binding) const;

  const vk::raii::Device* device_;
  std::vector<Binding> bindings_;
  vk::raii::DescriptorPool pool_;
  vk::raii::DescriptorSets sets_;
};

}  // namespace atlaswire::render
