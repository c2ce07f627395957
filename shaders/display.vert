#version 460
#extension GL_GOOGLE_include_directive : require
// Pre-shaded triangles for the newest pose ([SAS] 3.6).
#include "shaders/display_layout.h"

layout(push_constant) uniform Draw { DisplayConstants draw; };

layout(location = 0) in vec3 position;
layout(location = 1) in uvec2 half_texel;  // atlas coordinate in half texels

layout(location = 0) out vec2 uv;

void main() {
  precise vec3 relative = (position - draw.camera_high.xyz) - draw.camera_low.xyz;
  gl_Position = draw.clip_from_relative * vec4(relative, 1.0);
  uv = vec2(half_texel) * draw.atlas_from_fixed;
}
