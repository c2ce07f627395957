// Bindings and arithmetic of level selection ([SAS] 4.3, eq. 2), as render/atlas/level_selection.cpp has it: all
// in integers, 256ths of an octave.
#include "shaders/alloc_layout.h"
#include "shaders/select_layout.h"

layout(push_constant) uniform Setting { SelectConstants set; };
layout(set = 0, binding = 0, std430) buffer SelectionBuffer { Selection selection; };
layout(set = 0, binding = 1, std430) readonly buffer Levels { uint levels[]; };  // shaders/level_layout.h
layout(set = 0, binding = 2, std430) buffer Wants { uint wants[]; };
layout(set = 0, binding = 3, std430) buffer Remembered { uint remembered[]; };  // each patch's want before demotion
layout(set = 0, binding = 4, std430) buffer Savings {
  uint savings[];  // by word of 32 patches: what taking back hysteresis saves; then the sums before each
};

const int kOctave = 256;
const int kStep = 32;  // of the bias and the histogram: an eighth
const int kAreaBias = 16384;

uint words() { return (set.patches + 31u) / 32u; }
int area_of(uint level) { return int(level & 0xffffu) - kAreaBias; }
int aspect_of(uint level) { return int(level) >> 16; }

/// log2 area of the block for a biased area.
int rounded_area(int area) { return clamp((area + kOctave / 2) >> 8, set.smallest, set.largest); }
int aspect_limit(int area_log2) { return min(set.largest - area_log2, area_log2 - set.smallest); }

int biased_area(uint level) { return min(area_of(level), set.highest_bin * kStep) - selection.step * kStep; }

uint texels_of(uint want) { return 1u << (int(((want >> 4) & 15u) + (want & 15u)) - set.smallest); }

/// The want of a patch without a past.
uint round_level(int area, int aspect) {
  int area_log2 = rounded_area(area);
  int parity = area_log2 & 1;
  int nearest = 2 * ((aspect - parity * kOctave + kOctave) >> 9) + parity;
  int limit = aspect_limit(area_log2);
  int aspect_log2 = clamp(nearest, -limit, limit);
  uint width = uint(area_log2 + abs(aspect_log2)) / 2u;
  uint height = uint(area_log2 - abs(aspect_log2)) / 2u;
  return kWantVisible | (aspect_log2 < 0 ? kTransposed : 0u) | width << 4 | height;
}

/// Whether a patch's previous want is still near enough: half a rounding step plus the margin.
bool keeps(uint want, int area, int aspect) {
  int width = int((want >> 4) & 15u);
  int height = int(want & 15u);
  int legal = clamp(area, set.smallest * kOctave, set.largest * kOctave);
  if (abs(legal - (width + height) * kOctave) > kOctave / 2 + set.margin) return false;
  int limit = aspect_limit(width + height) * kOctave;
  int aspect_log2 = (want & kTransposed) != 0u ? height - width : width - height;
  return abs(clamp(aspect, -limit, limit) - aspect_log2 * kOctave) <= kOctave + 2 * set.margin;
}
