#version 460
#extension GL_GOOGLE_include_directive : require
// Writes the patch that a pixel shows, unless the material has a hole there.
#include "shaders/scene_layout.h"

layout(set = 1, binding = 0) uniform MaterialBlock { MaterialConstants material; };
layout(set = 1, binding = 1) uniform sampler2D base_color_texture;

layout(location = 0) flat in uint patch_id;
layout(location = 1) in vec2 uv;
layout(location = 0) out uint id;

void main() {
  if (material.base_color.a * texture(base_color_texture, uv).a < material.factors.w) discard;
  id = patch_id;
}
