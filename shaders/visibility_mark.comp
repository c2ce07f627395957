#version 460
#extension GL_GOOGLE_include_directive : require
// Marks every patch that the id buffer shows. Each invocation reads a short run of a row and stores a patch
// once a run of equal ids.
#include "shaders/visibility_layout.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1, std430) writeonly buffer Marks { uint marks[]; };
layout(set = 0, binding = 2) uniform usampler2D ids;

void main() {
  ivec2 extent = textureSize(ids, 0);
  int x = int(gl_GlobalInvocationID.x * kMarkRun);
  int y = int(gl_GlobalInvocationID.y);
  if (y >= extent.y) return;
  int end = min(x + int(kMarkRun), extent.x);
  uint last = kNoPatch;
  for (; x < end; ++x) {
    uint id = texelFetch(ids, ivec2(x, y), 0).r;
    if (id != last && id != kNoPatch) marks[id] = 1u;
    last = id;
  }
}
