// Push constants of the lens correction. Included by GLSL and by C++.
#ifndef ATLASWIRE_SHADERS_LENS_LAYOUT_H
#define ATLASWIRE_SHADERS_LENS_LAYOUT_H

#ifdef __cplusplus
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
namespace atlaswire::render::gpu_layout {
using vec4 = glm::vec4;
using vec2 = glm::vec2;
#endif

struct LensConstants {
  vec4 k1;      // red, green, blue; w unused
  vec4 k2;
  vec2 extent;  // pixels of the eye's picture
  vec2 corner;  // where its top left corner goes in the whole picture
};

#ifdef __cplusplus
static_assert(offsetof(LensConstants, corner) == 40);
}  // namespace atlaswire::render::gpu_layout
#endif

#endif  // ATLASWIRE_SHADERS_LENS_LAYOUT_H
