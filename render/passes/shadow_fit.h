#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>

namespace atlaswire::render {

struct ShadingVertex;

/// The orthographic view that the sun has of a scene.
struct ShadowFit {
  /// Affine rows: scene position to shadow map (u, v in [0, 1], depth in [0, 1] with 1 nearest the sun).
  std::array<glm::vec4, 3> rows{};
  float texel = 0.0F;  ///< metres a texel of the map covers, the longer side
  float depth = 0.0F;  ///< metres that depth 0..1 covers
};

/// Fits the view tightly around all vertices, `size` texels along each side. `direction`: the way light
/// travels, unit. No vertices give the identity.
ShadowFit fit_shadow(std::span<const ShadingVertex> vertices, const glm::vec3& direction, float size);

}  // namespace atlaswire::render
