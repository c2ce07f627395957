#version 460
#extension GL_GOOGLE_include_directive : require
// A patch's corner at its place in the atlas ([SAS] 3.2): the host gives the texel position and which of the
// scene's vertices it is.
#include "shaders/octahedral.glsl"
#include "shaders/scene_layout.h"

layout(push_constant) uniform Draw { DrawConstants draw; };

// ShadingVertex, 7 words each: position, normal, tangent, uv.
layout(set = 0, binding = 4, std430) readonly buffer Vertices { uint vertex_words[]; };

layout(location = 0) in uint vertex;
layout(location = 1) in uint in_light_list;
layout(location = 2) in vec2 texel;

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 tangent;
layout(location = 3) out vec2 uv;
layout(location = 4) flat out uint light_list;

void main() {
  uint at = vertex * 7u;
  position = uintBitsToFloat(uvec3(vertex_words[at], vertex_words[at + 1u], vertex_words[at + 2u]));
  normal = unpack_normal(vertex_words[at + 3u]);
  tangent = unpack_tangent(vertex_words[at + 4u]);
  uv = uintBitsToFloat(uvec2(vertex_words[at + 5u], vertex_words[at + 6u]));
  light_list = in_light_list;
  gl_Position = vec4(texel * draw.clip_from_texel - 1.0, 0.0, 1.0);
}
