#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the patches that take part in this frame, ascending, behind the deferred blocks: an invocation for
// each 32 patches, most of which have nothing to list.
#include "shaders/alloc_state.glsl"

layout(local_size_x = kGroup) in;

void main() {
  uint word = gl_GlobalInvocationID.x;
  if (word >= event_words()) return;
  uint bits = event_count_before[event_words() + word];
  event_count_before[event_words() + word] = 0u;
  uint at = set.patches + event_count_before[word];
  while (bits != 0u) {
    uint i = word * 32u + uint(findLSB(bits));
    bits &= bits - 1u;
    uint want = wants[i];
    uint shape = records[i].shape;
    items[at] = make_item(i, classify(want, shape, store.reset != 0u), want, shape);
    ++at;
  }
}
