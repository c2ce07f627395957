#version 460
#extension GL_GOOGLE_include_directive : require
// One work group a counter and level: from slots within tiles to slots within the frame.
#include "shaders/alloc_state.glsl"
#include "shaders/alloc_scan.glsl"

layout(local_size_x = kGroup) in;

void main() {
  uint key = gl_WorkGroupID.x;
  uint tiles = store.item_groups[0];
  uint before = 0u;
  for (uint first = 0u; first < tiles; first += kGroup) {
    uint tile = first + gl_LocalInvocationID.x;
    uint total;
    uint place = scan_group(tile < tiles ? tile_counts[key * set.tiles + tile] : 0u, total);
    if (tile < tiles) tile_counts[key * set.tiles + tile] = before + place;
    before += total;
  }
  if (gl_LocalInvocationID.x == 0u) store.counted[key] = before;
}
