#version 460
#extension GL_GOOGLE_include_directive : require
// What each patch wants: its last level, while that is near enough, else the rounded one.
#include "shaders/select_state.glsl"

layout(local_size_x = kSelectGroup) in;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= set.patches) return;
  uint level = levels[i];
  uint want = wants[i] != 0u ? wants[i] : remembered[i];
  remembered[i] = want;
  if (level == 0u) {
    wants[i] = 0u;
    return;
  }
  int area = biased_area(level);
  int aspect = aspect_of(level);
  uint fresh = round_level(area, aspect);
  if (want == 0u || !keeps(want, area, aspect)) {
    want = fresh;
    remembered[i] = want;
  }
  wants[i] = want;
  atomicAdd(selection.texels, texels_of(want));
  if (texels_of(fresh) < texels_of(want)) {
    atomicAdd(savings[i / 32u], texels_of(want) - texels_of(fresh));
  }
}
