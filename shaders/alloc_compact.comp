#version 460
#extension GL_GOOGLE_include_directive : require
// One work group a level: the stack's entries in reclaimed superblocks leave it, the others keep their order.
// In place: what is written lies never above what has been read.
#include "shaders/alloc_state.glsl"
#include "shaders/alloc_scan.glsl"

layout(local_size_x = kGroup) in;

void main() {
  uint level = gl_WorkGroupID.x;
  uint base = store.stack_base[level];
  uint size = store.stack_size[level];
  uint kept = 0u;
  for (uint first = 0u; first < size; first += kGroup) {
    uint i = first + gl_LocalInvocationID.x;
    uint at = i < size ? stacks[base + i] : 0u;
    bool keep = i < size && superblocks[superblock_of(at)].reclaimed == 0u;
    uint total;
    uint place = scan_flag(keep, total);
    if (keep) stacks[base + kept + place] = at;
    kept += total;
  }
  if (gl_LocalInvocationID.x == 0u) store.stack_size[level] = kept;
}
