#version 460
// The atlas's colour: a single bilinear fetch.
layout(constant_id = 0) const uint kAlpha = 0u;  // PatchClass::Alpha

layout(set = 0, binding = 0) uniform sampler2D atlas;

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

void main() {
  vec4 texel = textureLod(atlas, uv, 0.0);
  if (kAlpha == 1u && texel.a < 0.5) discard;
  color = vec4(texel.rgb, kAlpha == 2u ? texel.a : 1.0);
}
