#version 460
#extension GL_GOOGLE_include_directive : require
// One view of the id pass: camera-relative positions in float, for scenes far from their camera's origin too.
// A triangle's first vertex says which patch it is.
#include "shaders/visibility_layout.h"

layout(push_constant) uniform View { ViewConstants view; };

layout(location = 0) in vec3 position;
layout(location = 1) in uint vertex_patch;
layout(location = 0) flat out uint patch_id;

void main() {
  precise vec3 relative = (position - view.camera_high.xyz) - view.camera_low.xyz;
  gl_Position = view.clip_from_relative * vec4(relative, 1.0);
  patch_id = vertex_patch;
}
