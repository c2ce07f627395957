#pragma once

#include "render/scene/scene.h"

#include <cstdint>
#include <functional>

namespace atlaswire::render {

/// Smooth noise in [0, 1] over a torus: `period` lattice cells on each side of the unit square, `seed` picks
/// the pattern. Equal on every machine.
float tiled_noise(glm::vec2 uv, std::uint32_t period, std::uint32_t seed);

/// Sum of `octaves` of tiled_noise, each finer by two and weaker by half; in [0, 1].
float tiled_fbm(glm::vec2 uv, std::uint32_t period, std::uint32_t octaves, std::uint32_t seed);

/// Fills a square texture from a function of uv in [0, 1)^2; values clamp to [0, 1].
Texture paint(const char* name, std::uint32_t side, bool srgb, const std::function<glm::vec4(glm::vec2)>& at);

/// A tangent-space normal map of a height field in [0, 1] that repeats; `depth` is the height of 1 in units
/// of the texture's width.
Texture normals_of(const char* name, std::uint32_t side, float depth,
                   const std::function<float(glm::vec2)>& height);

}  // namespace atlaswire::render
