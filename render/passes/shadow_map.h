#pragma once

#include "render/gpu/image.h"
#include "render/gpu/pipeline.h"

namespace atlaswire::render {

class SceneGpu;

/// Draws a scene's casters as its sun sees them, depth reversed (1 nearest the sun). Opaque and masked
/// surfaces cast shadows, blended ones do not.
class ShadowPass {
 public:
  ShadowPass(const Device& device, const SceneGpu& scene);

  /// Draws them into `map` and leaves it ready to be sampled.
  void record(const vk::raii::CommandBuffer& commands, const SceneGpu& scene, Image& map) const;

 private:
  Pipeline solid_;
  Pipeline masked_;
};

/// Fills `map` with "nothing is in the way" and leaves it ready to be sampled.
void clear_shadow_map(const vk::raii::CommandBuffer& commands, Image& map);

}  // namespace atlaswire::render
