#include "render/gpu/descriptors.h"

#include "base/assert.h"

#include <algorithm>

namespace atlaswire::render {
namespace {

vk::raii::DescriptorSetLayout make_layout(const Device& device, const std::vector<Binding>& bindings) {
  std::vector<vk::DescriptorSetLayoutBinding> raw;
  raw.reserve(bindings.size());
  for (const Binding& b : bindings) {
    raw.push_back(
        {.binding = b.binding, .descriptorType = b.type, .descriptorCount = b.count, .stageFlags = b.stages});
  }
  return {device.vk(), {.bindingCount = static_cast<std::uint32_t>(raw.size()), .pBindings = raw.data()}};
}

vk::raii::DescriptorPool make_pool(const Device& device, const std::vector<Binding>& bindings,
                                   std::uint32_t sets) {
  std::vector<vk::DescriptorPoolSize> sizes;
  sizes.reserve(bindings.size());
  for (const Binding& b : bindings) sizes.push_back({.type = b.type, .descriptorCount = b.count * sets});
  return {device.vk(),
          {.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
           .maxSets = sets,
           .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
           .pPoolSizes = sizes.data()}};
}

vk::raii::DescriptorSets make_sets(const Device& device, const vk::raii::DescriptorPool& pool,
                                   vk::DescriptorSetLayout layout, std::uint32_t count) {
  const std::vector<vk::DescriptorSetLayout> layouts(count, layout);
  return {device.vk(), {.descriptorPool = *pool, .descriptorSetCount = count, .pSetLayouts = layouts.data()}};
}

}  // namespace

DescriptorLayout::DescriptorLayout(const Device& device, const std::string& name,
                                   std::vector<Binding> bindings)
    : bindings_(std::move(bindings)), layout_(make_layout(device, bindings_)) {
  device.set_name(layout_, name + " layout");
}

DescriptorSets::DescriptorSets(const Device& device, const std::string& name, const DescriptorLayout& layout,
                               std::uint32_t count)
    : device_(&device.vk()),
      bindings_(layout.bindings()),
      pool_(make_pool(device, bindings_, std::max<std::uint32_t>(count, 1))),
      sets_(make_sets(device, pool_, layout.handle(), std::max<std::uint32_t>(count, 1))) {
  device.set_name(pool_, name + " pool");
  for (const auto& set : sets_) device.set_name(set, name);
}

vk::DescriptorType DescriptorSets::type_of(std::uint32_t binding) const {
  const auto found = std::ranges::find(bindings_, binding, &Binding::binding);
  AW_ASSERT(found != bindings_.end());
  return found->type;
}

void DescriptorSets::write(std::uint32_t set, std::uint32_t binding, const Buffer& buffer) {
  const vk::DescriptorBufferInfo info{.buffer = buffer.handle(), .offset = 0, .range = VK_WHOLE_SIZE};
  device_->updateDescriptorSets(vk::WriteDescriptorSet{.dstSet = handle(set),
                                                       .dstBinding = binding,
                                                       .descriptorCount = 1,
                                                       .descriptorType = type_of(binding),
                                                       .pBufferInfo = &info},
                                {});
}

void DescriptorSets::write(std::uint32_t set, std::uint32_t binding, const Image& image) {
  const vk::DescriptorImageInfo info{.imageView = image.view(), .imageLayout = vk::ImageLayout::eGeneral};
  device_->updateDescriptorSets(vk::WriteDescriptorSet{.dstSet = handle(set),
                                                       .dstBinding = binding,
                                                       .descriptorCount = 1,
                                                       .descriptorType = type_of(binding),
                                                       .pImageInfo = &info},
                                {});
}

void DescriptorSets::write(std::uint32_t set, std::uint32_t binding, const Image& image,
                           const vk::raii::Sampler& sampler, std::uint32_t element) {
  const vk::DescriptorImageInfo info{
      .sampler = *sampler, .imageView = image.view(), .imageLayout = vk::ImageLayout::eShaderReadOnlyOptimal};
  device_->updateDescriptorSets(vk::WriteDescriptorSet{.dstSet = handle(set),
                                                       .dstBinding = binding,
                                                       .dstArrayElement = element,
                                                       .descriptorCount = 1,
                                                       .descriptorType = type_of(binding),
                                                       .pImageInfo = &info},
                                {});
}

}  // namespace atlaswire::render
