#version 460
#extension GL_GOOGLE_include_directive : require
// One work group: the smallest bias at which all blocks fit, from the exact area that each would give; then it
// moves, up at once, down slowly.
#include "shaders/select_state.glsl"

layout(local_size_x = kSelectGroup) in;

shared uint bins[kMostBins];
shared int fits;
shared uint visible;

/// In smallest blocks; saturates. Never rises with the bias.
uint predicted(int step) {
  uint sum = 0u;
  int count = set.highest_bin - set.lowest_bin + 1;
  for (int i = 0; i < count; ++i) {
    if (bins[i] == 0u) continue;
    uint shift = uint(rounded_area((set.lowest_bin + i - step) * kStep) - set.smallest);
    sum = min(kSaturated, sum + (bins[i] > (kSaturated >> shift) ? kSaturated : bins[i] << shift));
  }
  return sum;
}

void main() {
  uint i = gl_LocalInvocationID.x;
  if (i == 0u) {
    fits = set.highest_step;
    visible = 0u;
  }
  for (uint bin = i; bin < kMostBins; bin += kSelectGroup) {
    bins[bin] = selection.histogram[bin];
    selection.histogram[bin] = 0u;
  }
  barrier();
  uint seen = 0u;
  for (uint bin = i; bin < kMostBins; bin += kSelectGroup) seen += bins[bin];
  if (seen != 0u) atomicAdd(visible, seen);
  for (int step = set.lowest_step + int(i); step < set.highest_step; step += int(kSelectGroup)) {
    if (predicted(step) > set.target) continue;
    atomicMin(fits, step);
    break;
  }
  barrier();
  if (i != 0u) return;
  int before = selection.step;
  if (visible != 0u) {
    if (selection.has_bias == 0u || fits > before) {
      selection.step = fits;
    } else if (fits <= before - 2) {
      selection.step = before - max(1, (before - fits) / 4);
    }
    selection.has_bias = 1u;
  }
  selection.visible = visible;
  selection.texels = 0u;
  selection.demoted = 0u;
}
