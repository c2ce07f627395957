// Marks a patch as visible, and, if it is the first to do so, lists it for the level pass.
#ifndef ATLASWIRE_SHADERS_VISIBILITY_LIST_GLSL
#define ATLASWIRE_SHADERS_VISIBILITY_LIST_GLSL

#include "shaders/visibility_layout.h"

layout(set = 0, binding = 1, std430) buffer Marks { uint marks[]; };
layout(set = 0, binding = 6, std430) buffer List { uint list[]; };

void mark(uint patch_id) {
  // The plain read spares most atomics; a stale 0 only costs one.
  if (marks[patch_id] != 0u || atomicExchange(marks[patch_id], kSeen) != 0u) return;
  uint at = atomicAdd(list[kListHeader - 1u], 1u);
  list[kListHeader + at] = patch_id;
  if (at % kListGroup == 0u) atomicAdd(list[0], 1u);
}

#endif
