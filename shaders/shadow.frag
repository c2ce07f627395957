#version 460
#extension GL_GOOGLE_include_directive : require
// Casters with a masked material: holes let the sun through.
#include "shaders/scene_layout.h"

layout(set = 1, binding = 0) uniform MaterialBlock { MaterialConstants material; };
layout(set = 1, binding = 1) uniform sampler2D base_color_texture;

layout(location = 0) in vec2 uv;

void main() {
  if (material.base_color.a * texture(base_color_texture, uv).a < material.factors.w) discard;
}
