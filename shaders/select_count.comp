#version 460
#extension GL_GOOGLE_include_directive : require
// Histogram of the visible patches' areas.
#include "shaders/select_state.glsl"

layout(local_size_x = kSelectGroup) in;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < words()) savings[i] = 0u;
  if (i >= set.patches) return;
  uint level = levels[i];
  if (level == 0u) return;
  int bin = clamp(area_of(level) >> 5, set.lowest_bin, set.highest_bin);
  atomicAdd(selection.histogram[bin - set.lowest_bin], 1u);
}
