#version 460
#extension GL_GOOGLE_include_directive : require
// Scene geometry as a camera sees it, camera-relative before the float matrix.
#include "shaders/octahedral.glsl"
#include "shaders/scene_layout.h"

layout(push_constant) uniform Draw { DrawConstants draw; };

layout(location = 0) in vec3 in_position;
layout(location = 1) in uint in_normal;
layout(location = 2) in uint in_tangent;
layout(location = 3) in vec2 in_uv;

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 tangent;
layout(location = 3) out vec2 uv;
layout(location = 4) flat out uint light_list;

void main() {
  position = in_position;
  normal = unpack_normal(in_normal);
  tangent = unpack_tangent(in_tangent);
  uv = in_uv;
  light_list = draw.light_list;
  precise vec3 relative = (in_position - draw.camera_high.xyz) - draw.camera_low.xyz;
  gl_Position = draw.clip_from_relative * vec4(relative, 1.0);
}
