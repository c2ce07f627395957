#version 460
// A decoded I420 picture to RGBA8: one invocation makes 8 x 2 pixels. Chroma is taken from the pixel's own
// 2 x 2 group, never interpolated: blocks are at least two texels wide, so no block's colour reaches another.
layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool kCoverage = false;

layout(push_constant) uniform Picture {
  uint width;   // of the colours, a multiple of 8
  uint height;  // even
} picture;

layout(set = 0, binding = 0, std430) readonly buffer Planes { uint words[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Texels { uvec4 texels[]; };  // RGBA8, four in one

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy) * ivec2(8, 2);
  if (at.x >= int(picture.width) || at.y >= int(picture.height)) return;
  uint total_height = kCoverage ? 2u * picture.height : picture.height;
  uint row_words = picture.width / 4u;
  uint luma_word = uint(at.y) * row_words + uint(at.x) / 4u;
  uint chroma_word = picture.width * total_height / 4u + (uint(at.y) / 2u * (picture.width / 2u) + uint(at.x) / 2u) / 4u;
  vec4 blue = unpackUnorm4x8(words[chroma_word]) - 128.0 / 255.0;
  vec4 red = unpackUnorm4x8(words[chroma_word + picture.width * total_height / 16u]) - 128.0 / 255.0;

  for (int row = 0; row < 2; ++row) {
    for (int half_block = 0; half_block < 2; ++half_block) {
      uint word = luma_word + uint(row) * row_words + uint(half_block);
      vec4 luma = unpackUnorm4x8(words[word]);
      vec4 coverage = vec4(1.0);
      if (kCoverage) coverage = unpackUnorm4x8(words[word + row_words * picture.height]);
      uvec4 four;
      for (int i = 0; i < 4; ++i) {
        int group = half_block * 2 + (i >> 1);
        vec3 rgb = luma[i] + vec3(1.5748 * red[group], -0.18732427 * blue[group] - 0.46812427 * red[group],
                                  1.8556 * blue[group]);
        four[i] = packUnorm4x8(vec4(rgb, coverage[i]));
      }
      texels[word] = four;
    }
  }
}
