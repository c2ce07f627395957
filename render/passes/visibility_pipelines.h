#pragma once

#include "render/gpu/pipeline.h"
#include "render/passes/scene_gpu.h"
#include "render/passes/visibility_draws.h"

#include <array>
#include <optional>

namespace atlaswire::render {

inline constexpr vk::Format kIdFormat = vk::Format::eR32Uint;
inline constexpr vk::Format kIdDepthFormat = vk::Format::eD32Sfloat;

/// Descriptor set 0 of all visibility shaders.
std::vector<Binding> visibility_bindings();

/// The pipelines of the visibility passes; id pipelines only for the classes that the scene has.
class VisibilityPipelines {
 public:
  VisibilityPipelines(const Device& device, const SceneGpu& scene, const DescriptorLayout& layout);

  /// The pipeline that draws a class that the scene has.
  [[nodiscard]] const Pipeline& draw(IdClass id_class, bool double_sided) const;
  [[nodiscard]] const Pipeline& mark() const { return mark_; }
  [[nodiscard]] const Pipeline& hold() const { return hold_; }
  [[nodiscard]] const Pipeline& level() const { return level_; }

 private:
  std::array<std::optional<Pipeline>, 6> draws_;  ///< by class, then single- and double-sided
  Pipeline mark_;
  Pipeline hold_;
  Pipeline level_;
};

}  // namespace atlaswire::render
