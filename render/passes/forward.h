#pragma once

#include "render/camera.h"
#include "render/gpu/offscreen_target.h"
#include "render/image/picture.h"
#include "render/passes/material_pipelines.h"
#include "render/passes/scene_gpu.h"

#include <memory>

namespace atlaswire::render {

/// The ground truth: a scene drawn for a camera with the same materials that shade the atlas, depth test,
/// glTF's culling, masks discarded, and blended patches over them from far to near. One thread at a time.
class ForwardPass {
 public:
  ForwardPass(Device& device, const SceneGpu& scene);

  /// Renders and waits. Alpha: 255 where opaque or masked geometry was hit, 0 where nothing was drawn.
  Picture render(const Camera& camera);
  /// Fragments of the last render() that passed the depth test when they were drawn, from near to far: what
  /// forward shading costs. Devices without precise occlusion queries may say less.
  [[nodiscard]] std::uint64_t fragments() const { return fragments_; }
  /// What render() drew into; null before the first, and another one whenever a camera has another extent.
  [[nodiscard]] OffscreenTarget* target() { return target_.get(); }
  /// Records the same drawing into a target of the camera's extent, and no read-back.
  void record(const vk::raii::CommandBuffer& commands, const Camera& camera, OffscreenTarget& target,
              OffscreenTarget::Depth depth_after = OffscreenTarget::Depth::kDropped) const;

 private:
  void draw_scene(const vk::raii::CommandBuffer& commands, const Camera& camera) const;

  SubmitContext context_;
  const SceneGpu* scene_;
  MaterialPipelines pipelines_;
  std::vector<std::uint32_t> first_triangle_;  ///< of each patch
  vk::raii::QueryPool query_;
  vk::QueryControlFlags precision_;
  std::uint64_t fragments_ = 0;
  std::unique_ptr<OffscreenTarget> target_;  ///< of the last camera's extent
};

}  // namespace atlaswire::render
