#version 460
#extension GL_GOOGLE_include_directive : require
// Casters as the sun sees them: orthographic, depth reversed.
#include "shaders/scene_layout.h"

layout(set = 0, binding = 0) uniform Constants { SceneConstants scene; };

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 in_uv;

layout(location = 0) out vec2 uv;

void main() {
  vec4 p = vec4(position, 1.0);
  vec3 at = vec3(dot(scene.shadow_row[0], p), dot(scene.shadow_row[1], p), dot(scene.shadow_row[2], p));
  uv = in_uv;
  gl_Position = vec4(at.xy * 2.0 - 1.0, at.z, 1.0);
}
