#pragma once

#include "render/gpu/image.h"
#include "render/gpu/submit_context.h"

namespace atlaswire::render {

class SceneGpu;

/// Renders the scene's casters into `map` as the sun sees them, depth reversed (1 nearest the sun), and
/// leaves it ready to be sampled. Opaque and masked surfaces cast shadows, blended ones do not. Waits.
void render_shadow_map(SubmitContext& context, const SceneGpu& scene, Image& map);

/// Fills `map` with "nothing is in the way" and leaves it ready to be sampled.
void clear_shadow_map(const vk::raii::CommandBuffer& commands, Image& map);

}  // namespace atlaswire::render
