#version 460
#extension GL_GOOGLE_include_directive : require
// One work group: of patches that were never admitted, only set.most_new may ask in a frame; the others' wants
// are taken back. The largest go first, of equal areas the lowest numbers (render/atlas/admission.h).
#include "shaders/alloc_state.glsl"
#include "shaders/alloc_scan.glsl"

layout(local_size_x = kGroup) in;
layout(set = 0, binding = 13, std430) buffer Admitted { uint admitted[]; };  // by patch

const uint kAreas = 32u;
shared uint newcomers[kAreas];  // by area
shared uint last;               // areas from here on get in whole, the one below in part
shared uint room;               // of that one

uint area_of(uint want) { return width_of(want & kSidesMask) + height_of(want & kSidesMask); }

void count_newcomers() {
  uint i = gl_LocalInvocationID.x;
  if (i < kAreas) newcomers[i] = 0u;
  barrier();
  for (uint patch_id = i; patch_id < set.patches; patch_id += kGroup) {
    if (set.reset == kMustReset) admitted[patch_id] = 0u;
    if (wants[patch_id] != 0u && admitted[patch_id] == 0u) {
      atomicAdd(newcomers[area_of(wants[patch_id])], 1u);
    }
  }
  barrier();
}

void share_room() {
  last = kAreas;
  room = set.most_new;
  while (last > 0u && newcomers[last - 1u] <= room) {
    --last;
    room -= newcomers[last];
  }
  uint waiting = 0u;
  for (uint area = 0u; area < last; ++area) waiting += newcomers[area];
  report.waiting = last == 0u ? 0u : waiting - room;
}

void main() {
  count_newcomers();
  if (gl_LocalInvocationID.x == 0u) share_room();
  barrier();
  uint taken = 0u;
  for (uint first = 0u; first < set.patches; first += kGroup) {
    uint patch_id = first + gl_LocalInvocationID.x;
    bool is_new = patch_id < set.patches && wants[patch_id] != 0u && admitted[patch_id] == 0u;
    uint area = is_new ? area_of(wants[patch_id]) : 0u;
    bool in_part = is_new && area + 1u == last;
    uint total = 0u;
    uint before = last != 0u ? scan_flag(in_part, total) : 0u;
    if (is_new) {
      bool waits = area + 1u < last || (in_part && taken + before >= room);
      if (waits) wants[patch_id] = 0u;
      admitted[patch_id] = waits ? 0u : 1u;
    }
    taken += total;
  }
}
