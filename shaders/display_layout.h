// Push constants of the display pass. Included by GLSL and by C++.
#ifndef ATLASWIRE_SHADERS_DISPLAY_LAYOUT_H
#define ATLASWIRE_SHADERS_DISPLAY_LAYOUT_H

#ifdef __cplusplus
#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
namespace atlaswire::render::gpu_layout {
using mat4 = glm::mat4;
using vec4 = glm::vec4;
using vec2 = glm::vec2;
#endif

struct DisplayConstants {
  mat4 clip_from_relative;  // projection times rotation
  vec4 camera_high;         // camera relative to the mesh's origin, rounded to float
  vec4 camera_low;          // what that rounding lost
  vec2 atlas_from_fixed;    // atlas texture coordinate of half a texel
};

#ifdef __cplusplus
static_assert(offsetof(DisplayConstants, atlas_from_fixed) == 96);
}  // namespace atlaswire::render::gpu_layout
#endif

#endif  // ATLASWIRE_SHADERS_DISPLAY_LAYOUT_H
