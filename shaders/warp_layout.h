// What the warps of ordinary pictures share with their shaders. Included by GLSL and by C++.
#ifndef ATLASWIRE_SHADERS_WARP_LAYOUT_H
#define ATLASWIRE_SHADERS_WARP_LAYOUT_H

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
namespace atlaswire::render::gpu_layout {
using vec2 = glm::vec2;
using vec4 = glm::vec4;
using uint = std::uint32_t;
#endif

// A PixelTransfer in floats: from the source's pixels to the display's (mesh) or back (the other two).
struct WarpConstants {
  vec4 homography_x;   // columns; w unused
  vec4 homography_y;
  vec4 homography_1;
  vec4 parallax;       // w: the largest inverse distance in the source
  vec2 source_extent;  // pixels
  vec2 target_extent;
  float near_plane;    // metres, of the display's camera
};

#ifdef __cplusplus
static_assert(offsetof(WarpConstants, near_plane) == 80);
}  // namespace atlaswire::render::gpu_layout
#endif

#endif  // ATLASWIRE_SHADERS_WARP_LAYOUT_H
