#version 460
#extension GL_GOOGLE_include_directive : require
// One view of the id pass for textured holes and glass: as visibility.vert, with texture coordinates.
#include "shaders/visibility_layout.h"

layout(push_constant) uniform View { ViewConstants view; };

layout(location = 0) in vec3 position;
layout(location = 1) in uint vertex_patch;
layout(location = 2) in vec2 vertex_uv;
layout(location = 0) flat out uint patch_id;
layout(location = 1) out vec2 uv;

void main() {
  precise vec3 relative = (position - view.camera_high.xyz) - view.camera_low.xyz;
  gl_Position = view.clip_from_relative * vec4(relative, 1.0);
  patch_id = vertex_patch;
  uv = vertex_uv;
}
