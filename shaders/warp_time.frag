#version 460
#extension GL_GOOGLE_include_directive : require
// Asynchronous time warp: each output pixel looks where the rotation alone puts it.
#include "shaders/warp.glsl"

layout(location = 0) out vec4 color;

void main() {
  vec3 h = at_infinity(gl_FragCoord.xy);
  vec2 pixel = h.xy / h.z;
  if (h.z <= 0.0 || !in_source(pixel)) discard;
  color = source_color(pixel);
}
