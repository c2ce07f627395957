#version 460
// RGBA to I420, BT.709 full range: one invocation makes 8 x 2 pixels, so that it writes whole words. A second luma
// plane may follow below the first (render/passes/i420_pass.h).
layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint kLowerHalf = 0u;  // I420Pass::LowerHalf: none, coverage, from the host

layout(push_constant) uniform Picture {
  uint width;   // of the colours, a multiple of 8
  uint height;  // even
} picture;

layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1, std430) writeonly buffer Planes { uint words[]; };

const vec3 kLuma = vec3(0.2126, 0.7152, 0.0722);

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy) * ivec2(8, 2);
  if (at.x >= int(picture.width) || at.y >= int(picture.height)) return;
  uint total_height = kLowerHalf == 0u ? picture.height : 2u * picture.height;
  uint luma_word = (uint(at.y) * picture.width + uint(at.x)) / 4u;
  uint row_words = picture.width / 4u;
  uint coverage_word = luma_word + row_words * picture.height;

  uint blue_chroma = 0u;
  uint red_chroma = 0u;
  for (int half_block = 0; half_block < 2; ++half_block) {
    vec4 p[8];
    for (int i = 0; i < 8; ++i) p[i] = texelFetch(source, at + ivec2(half_block * 4 + (i & 3), i >> 2), 0);
    for (int row = 0; row < 2; ++row) {
      vec4 y = vec4(dot(p[row * 4].rgb, kLuma), dot(p[row * 4 + 1].rgb, kLuma), dot(p[row * 4 + 2].rgb, kLuma),
                    dot(p[row * 4 + 3].rgb, kLuma));
      words[luma_word + uint(row) * row_words + uint(half_block)] = packUnorm4x8(y);
      if (kLowerHalf == 1u) {
        words[coverage_word + uint(row) * row_words + uint(half_block)] =
            packUnorm4x8(vec4(p[row * 4].a, p[row * 4 + 1].a, p[row * 4 + 2].a, p[row * 4 + 3].a));
      }
    }
    for (int pair = 0; pair < 2; ++pair) {
      vec3 mean = 0.25 * (p[pair * 2].rgb + p[pair * 2 + 1].rgb + p[pair * 2 + 4].rgb + p[pair * 2 + 5].rgb);
      float luma = dot(mean, kLuma);
      vec2 chroma = (mean.br - luma) / vec2(1.8556, 1.5748) * 255.0 + 128.5;
      uvec2 octets = uvec2(clamp(chroma, 0.0, 255.0));
      uint shift = uint(half_block * 16 + pair * 8);
      blue_chroma |= octets.x << shift;
      red_chroma |= octets.y << shift;
    }
  }
  uint chroma_word = (uint(at.y) / 2u * (picture.width / 2u) + uint(at.x) / 2u) / 4u;
  uint first_chroma = picture.width * total_height / 4u;
  uint chroma_plane_words = picture.width / 2u * (total_height / 2u) / 4u;
  words[first_chroma + chroma_word] = blue_chroma;
  words[first_chroma + chroma_plane_words + chroma_word] = red_chroma;
}
