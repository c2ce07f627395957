#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the patches that take part in this frame, ascending, behind the deferred blocks.
#include "shaders/alloc_state.glsl"
#include "shaders/alloc_scan.glsl"

layout(local_size_x = kGroup) in;

void main() {
  uint group = gl_WorkGroupID.x;
  uint first = group_events[group];
  uint end = group + 1u < gl_NumWorkGroups.x ? group_events[group + 1u] : store.events;
  if (end == first) return;  // uniform
  uint i = gl_GlobalInvocationID.x;
  uint want = 0u;
  uint shape = 0u;
  uint what = 0u;
  if (i < set.patches) {
    want = wants[i];
    shape = records[i].shape;
    what = classify(want, shape, store.reset != 0u);
  }
  uint total;
  uint place = scan_group(what != 0u ? 1u : 0u, total);
  if (what != 0u) items[set.patches + first + place] = make_item(i, what, want, shape);
}
