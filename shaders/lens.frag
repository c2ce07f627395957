#version 460
#extension GL_GOOGLE_include_directive : require
// Radial correction of a magnifying lens, for each colour channel by itself ([SAS] 3.6).
#include "shaders/lens_layout.h"

layout(push_constant) uniform Draw { LensConstants draw; };
layout(set = 0, binding = 0) uniform sampler2D eye_picture;

layout(location = 0) out vec4 color;

// What the lens brings to `pixel` in one channel: nothing from beyond the picture's border.
vec4 seen(vec2 pixel, int channel) {
  vec2 from_centre = pixel - 0.5 * draw.extent;
  vec2 scaled = from_centre / (0.5 * draw.extent.y);
  float r2 = dot(scaled, scaled);
  // The displacement alone is computed, so that without distortion pixels stay exactly in their places.
  vec2 source = pixel + from_centre * (r2 * (draw.k1[channel] + r2 * draw.k2[channel]));
  bool inside = all(greaterThanEqual(source, vec2(0.0))) && all(lessThanEqual(source, draw.extent));
  return inside ? textureLod(eye_picture, source / draw.extent, 0.0) : vec4(0.0);
}

void main() {
  vec2 pixel = gl_FragCoord.xy - draw.corner;
  vec4 green = seen(pixel, 1);
  color = vec4(seen(pixel, 0).r, green.g, seen(pixel, 2).b, green.a);
}
