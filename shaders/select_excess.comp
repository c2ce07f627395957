#version 460
#extension GL_GOOGLE_include_directive : require
// One work group: if the wants exceed the target, what can be saved before each word of patches.
#include "shaders/alloc_layout.h"
#include "shaders/alloc_scan.glsl"
#include "shaders/select_state.glsl"

layout(local_size_x = kSelectGroup) in;

void main() {
  uint i = gl_LocalInvocationID.x;
  uint excess = selection.texels - min(selection.texels, set.target);
  if (i == 0u) {
    selection.excess = excess;
    selection.demote_groups[0] = excess != 0u ? (set.patches + kSelectGroup - 1u) / kSelectGroup : 0u;
  }
  if (excess == 0u) return;  // uniform
  uint run = (words() + kSelectGroup - 1u) / kSelectGroup;
  uint first = min(i * run, words());
  uint end = min(first + run, words());
  uint mine = 0u;
  for (uint word = first; word < end; ++word) mine += savings[word];
  uint total;
  uint before = scan_group(mine, total);
  for (uint word = first; word < end; ++word) {
    savings[words() + word] = before;
    before += savings[word];
  }
}
