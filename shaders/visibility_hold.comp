#version 460
#extension GL_GOOGLE_include_directive : require
// Keeps patches listed for some frames after they were last seen: what is smaller than a pixel is seen in one
// frame and missed in the next. The level pass drops those that are not small.
#include "shaders/visibility_list.glsl"

layout(local_size_x = kListGroup) in;

layout(push_constant) uniform Hold { HoldConstants hold; };
// A word a patch: for how many more frames it counts as visible without being seen.
layout(set = 0, binding = 8, std430) buffer Held { uint held[]; };

void main() {
  uint patch_id = gl_GlobalInvocationID.x;
  if (patch_id >= hold.patches) return;
  if (marks[patch_id] != 0u) {
    held[patch_id] = hold.frames;
  } else if (held[patch_id] != 0u) {
    --held[patch_id];
    mark(patch_id);
    marks[patch_id] = kHeld;
  }
}
