// What the visibility passes and render/passes/visibility.cpp share. Included by GLSL and by C++.
#ifndef ATLASWIRE_SHADERS_VISIBILITY_LAYOUT_H
#define ATLASWIRE_SHADERS_VISIBILITY_LAYOUT_H

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
namespace atlaswire::render::visibility {
using mat4 = glm::mat4;
using vec4 = glm::vec4;
using uint = std::uint32_t;
#endif

/// Push constants of the id pass: one view.
struct ViewConstants {
  mat4 clip_from_relative;  ///< projection times rotation
  vec4 camera_high;         ///< camera position relative to the scene's origin, rounded to float
  vec4 camera_low;          ///< what that rounding lost
};

#ifdef __cplusplus
static_assert(sizeof(ViewConstants) == 96);
static_assert(offsetof(ViewConstants, camera_high) == 64);
static_assert(offsetof(ViewConstants, camera_low) == 80);

/// The id of a pixel that shows nothing.
inline constexpr std::uint32_t kNoPatch = 0xffffffffU;
}  // namespace atlaswire::render::visibility
#else
const uint kNoPatch = 0xffffffffu;
#endif

#endif  // ATLASWIRE_SHADERS_VISIBILITY_LAYOUT_H
