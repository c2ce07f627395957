// What the warps share: push constants and the source picture.
#include "shaders/warp_layout.h"

layout(push_constant) uniform Draw { WarpConstants draw; };

layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1, std430) readonly buffer Depth { float inverse_distance[]; };

// Homogeneous pixel in the other view of a point infinitely far.
vec3 at_infinity(vec2 pixel) {
  return draw.homography_x.xyz * pixel.x + draw.homography_y.xyz * pixel.y + draw.homography_1.xyz;
}

bool in_source(vec2 pixel) {
  return all(greaterThanEqual(pixel, vec2(0.0))) && all(lessThanEqual(pixel, draw.source_extent));
}

vec4 source_color(vec2 pixel) { return vec4(textureLod(source, pixel / draw.source_extent, 0.0).rgb, 1.0); }
