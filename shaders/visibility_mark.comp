#version 460
#extension GL_GOOGLE_include_directive : require
// Marks every patch that the id buffer shows. Each invocation reads a short run of a row, and then marks
// where ids change: a loop of few turns where a branch in each pixel would be taken by all.
#include "shaders/visibility_list.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2) uniform usampler2D ids;

void main() {
  ivec2 extent = textureSize(ids, 0);
  int x = int(gl_GlobalInvocationID.x * kMarkRun);
  int y = int(gl_GlobalInvocationID.y);
  if (x >= extent.x || y >= extent.y) return;
  int last = extent.x - 1;
  uint changes = 1u;
  uint id = texelFetch(ids, ivec2(x, y), 0).r;
  for (int i = 1; i < int(kMarkRun); ++i) {
    uint next = texelFetch(ids, ivec2(min(x + i, last), y), 0).r;
    changes |= next != id ? 1u << i : 0u;
    id = next;
  }
  while (changes != 0u) {
    uint changed = texelFetch(ids, ivec2(x + findLSB(changes), y), 0).r;
    if (changed != kNoPatch) mark(changed);
    changes &= changes - 1u;
  }
}
