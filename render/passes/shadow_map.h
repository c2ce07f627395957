#pragma once

#include "render/gpu/image.h"
#include "render/gpu/pipeline.h"
#include "render/gpu/submit_context.h"

#include <cstdint>

namespace atlaswire::render {

class SceneGpu;

/// Which of a scene's casters.
enum class Casters : std::uint8_t { kAll, kResting, kMoving };

/// Draws a scene's casters as its sun sees them, depth reversed (1 nearest the sun). Opaque and masked
/// surfaces cast shadows, blended ones do not.
class ShadowPass {
 public:
  ShadowPass(const Device& device, const SceneGpu& scene);

  /// Draws them into `map`, those that move over what is in it, and leaves it in use as a depth target.
  void record(const vk::raii::CommandBuffer& commands, const SceneGpu& scene, Image& map,
              Casters casters) const;

 private:
  Pipeline solid_;
  Pipeline masked_;
};

/// Keeps the shadow map of a scene that moves: what rests is drawn once, and copied beneath what moves.
class MovingShadows {
 public:
  /// `extent`: the map's, which needs usage eTransferDst. Draws what rests, and waits.
  MovingShadows(SubmitContext& context, const SceneGpu& scene, Extent2D extent);

  /// Draws `map` anew and leaves it ready to be sampled.
  void record(const vk::raii::CommandBuffer& commands, const SceneGpu& scene, Image& map);

 private:
  ShadowPass pass_;
  Image resting_;
};

/// Fills `map` with "nothing is in the way" and leaves it ready to be sampled.
void clear_shadow_map(const vk::raii::CommandBuffer& commands, Image& map);

}  // namespace atlaswire::render
