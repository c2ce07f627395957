#version 460
#extension GL_GOOGLE_include_directive : require
// A blended surface hides nothing: its patch is marked at once where it passes the depth test, and neither
// id nor depth is written.
#include "shaders/scene_layout.h"
#include "shaders/visibility_list.glsl"

layout(early_fragment_tests) in;

layout(set = 1, binding = 0) uniform MaterialBlock { MaterialConstants material; };
layout(set = 1, binding = 1) uniform sampler2D base_color_texture;

layout(location = 0) flat in uint patch_id;
layout(location = 1) in vec2 uv;

void main() {
  // Less than half of one level of eight bits shows nothing.
  if (material.base_color.a * texture(base_color_texture, uv).a < 0.5 / 255.0) return;
  mark(patch_id);
}
