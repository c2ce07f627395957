#pragma once

#include "render/camera.h"
#include "render/image/picture.h"
#include "render/passes/material_pipelines.h"
#include "render/passes/scene_gpu.h"

#include <memory>

namespace atlaswire::render {

struct OffscreenTarget;

/// The ground truth: a scene drawn for a camera with the same materials that shade the atlas, depth test,
/// glTF's culling, masks discarded, and blended patches over them from far to near. One thread at a time.
class ForwardPass {
 public:
  ForwardPass(Device& device, const SceneGpu& scene);
  ~ForwardPass();

  /// Renders and waits. Alpha: 255 where opaque or masked geometry was hit, 0 where nothing was drawn.
  Picture render(const Camera& camera);

 private:
  void record(const vk::raii::CommandBuffer& commands, const Camera& camera);
  void draw_scene(const vk::raii::CommandBuffer& commands, const Camera& camera);

  SubmitContext context_;
  const SceneGpu* scene_;
  MaterialPipelines pipelines_;
  std::vector<std::uint32_t> first_triangle_;  ///< of each patch
  std::unique_ptr<OffscreenTarget> target_;    ///< of the last camera's extent
};

}  // namespace atlaswire::render
