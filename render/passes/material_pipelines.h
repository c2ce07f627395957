#pragma once

#include "render/gpu/pipeline.h"
#include "render/passes/scene_gpu.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace atlaswire::render {

/// The pipelines of a pass that draws a scene's materials: one for each distinct set of features that the
/// scene has, shared by the materials with that set.
class MaterialPipelines {
 public:
  /// Where the pipelines draw to.
  enum class Target : std::uint8_t {
    kAtlas,   ///< shaders/shading.vert, no depth, no culling, coverage in alpha
    kCamera,  ///< shaders/forward.vert, reversed depth, glTF's culling, masks discarded, blending
  };
  MaterialPipelines(const Device& device, const SceneGpu& scene, Target target);

  /// Binds the material's pipeline and sets, leaving out what `previous` (the material bound last in this
  /// recording, or kNone) has bound already. Push constants survive it: all layouts are compatible.
  void bind(const vk::raii::CommandBuffer& commands, std::size_t material, std::size_t previous) const;
  void push(const vk::raii::CommandBuffer& commands, const gpu_layout::DrawConstants& constants) const;

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

 private:
  const SceneGpu* scene_;
  std::vector<std::unique_ptr<Pipeline>> pipelines_;
  std::vector<const Pipeline*> of_material_;
};

}  // namespace atlaswire::render
