#version 460
#extension GL_GOOGLE_include_directive : require
// Takes hysteresis back, in patch order, until memory suffices: from each patch before which not enough is saved.
#include "shaders/select_state.glsl"

layout(local_size_x = kSelectGroup) in;

/// What taking a patch's hysteresis back saves; `fresh` becomes its want without.
uint saving(uint level, uint want, out uint fresh) {
  fresh = round_level(biased_area(level), aspect_of(level));
  return texels_of(want) - min(texels_of(want), texels_of(fresh));
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= set.patches) return;
  uint word = i / 32u;
  uint before = savings[words() + word];
  if (savings[word] == 0u || before >= selection.excess || levels[i] == 0u) return;
  uint fresh;
  uint mine = saving(levels[i], remembered[i], fresh);
  if (mine == 0u) return;
  uint ignored;
  for (uint k = word * 32u; k < i && before < selection.excess; ++k) {
    if (levels[k] != 0u) before += saving(levels[k], remembered[k], ignored);
  }
  if (before >= selection.excess) return;
  wants[i] = fresh;
  atomicAdd(selection.texels, 0u - mine);
  atomicAdd(selection.demoted, 1u);
}
