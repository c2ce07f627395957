#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation a counter and level: from slots within tiles to slots within the frame. Most frames have few
// tiles, and neighbours read neighbouring words.
#include "shaders/alloc_state.glsl"

layout(local_size_x = kKeyGroup) in;

void main() {
  uint keys = kCounters * set.levels;
  uint key = gl_GlobalInvocationID.x;
  if (key >= keys) return;
  uint tiles = store.item_groups[0];
  uint before = 0u;
  for (uint tile = 0u; tile < tiles; ++tile) {
    uint count = tile_counts[tile * keys + key];
    tile_counts[tile * keys + key] = before;
    before += count;
  }
  store.counted[key] = before;
}
