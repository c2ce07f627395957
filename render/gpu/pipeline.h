#pragma once

#include "base/units.h"
#include "render/gpu/descriptors.h"

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace atlaswire::render {

/// SPIR-V as atlaswire::shaders names it.
using ShaderWords = std::span<const std::uint32_t>;

/// Specialization constants: (constant_id, value); bools are 0 or 1, floats their bits.
using Specialization = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// A compute pipeline; push constants start at byte 0.
struct ComputeSettings {
  std::string name;
  ShaderWords shader;
  std::vector<vk::DescriptorSetLayout> layouts;
  std::uint32_t push_constant_bytes = 0;
  Specialization specialization;
};

/// A graphics pipeline for dynamic rendering; viewport and scissor are dynamic. `fragment` may be empty
/// (depth only).
struct GraphicsSettings {
  std::string name;
  ShaderWords vertex;
  ShaderWords fragment;
  std::vector<vk::DescriptorSetLayout> layouts;
  std::uint32_t push_constant_bytes = 0;  ///< seen by both stages
  Specialization specialization;          ///< given to both stages
  std::vector<vk::VertexInputBindingDescription> vertex_bindings;
  std::vector<vk::VertexInputAttributeDescription> vertex_attributes;
  vk::PrimitiveTopology topology = vk::PrimitiveTopology::eTriangleList;
  vk::CullModeFlags cull = vk::CullModeFlagBits::eNone;
  vk::FrontFace front = vk::FrontFace::eCounterClockwise;
  std::vector<vk::Format> colors;
  vk::Format depth = vk::Format::eUndefined;
  bool depth_test = true;  ///< only with a depth format
  bool depth_write = true;
  vk::CompareOp depth_compare = vk::CompareOp::eGreater;  ///< reversed-Z
  float depth_bias = 0.0F;
  float depth_bias_slope = 0.0F;
  bool write_colors = true;
  bool blend = false;  ///< source over, straight alpha in, coverage accumulated in alpha
};

/// A pipeline and its layout.
class Pipeline {
 public:
  Pipeline(const Device& device, const ComputeSettings& settings);
  Pipeline(const Device& device, const GraphicsSettings& settings);

  [[nodiscard]] vk::Pipeline handle() const { return *pipeline_; }
  [[nodiscard]] vk::PipelineLayout layout() const { return *layout_; }
  /// Binds the pipeline and sets 0.. in order.
  void bind(const vk::raii::CommandBuffer& commands,
            std::initializer_list<vk::DescriptorSet> sets = {}) const;
  /// Sets push constants from byte 0; `T` has the size that the settings gave.
  template <class T>
  void push(const vk::raii::CommandBuffer& commands, const T& constants) const {
    commands.pushConstants<T>(*layout_, stages_, 0, constants);
  }

 private:
  vk::PipelineBindPoint point_;
  vk::ShaderStageFlags stages_;
  vk::raii::PipelineLayout layout_;
  vk::raii::Pipeline pipeline_;
};

/// Sets viewport and scissor to all of `extent`, depth 0..1.
void set_viewport(const vk::raii::CommandBuffer& commands, Extent2D extent);

/// Work groups of `size` invocations that cover `count`.
constexpr std::uint32_t group_count(std::uint64_t count, std::uint32_t size) {
  return static_cast<std::uint32_t>((count + size - 1) / size);
}

}  // namespace atlaswire::render
