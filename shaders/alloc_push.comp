#version 460
#extension GL_GOOGLE_include_directive : require
// Released blocks go onto their level's stack.
#include "shaders/alloc_state.glsl"

layout(local_size_x = kGroup) in;

void push(uint position, uint level, uint slot) {
  stacks[store.stack_base[level] + store.stack_size[level] + slot] = position;
}

/// With atomic counters nothing is ranked: what the rank pass decides is decided here.
void push_drawing(uint i) {
  Record block;
  if (i < store.deferred) {
    block = deferred_blocks[i];
  } else {
    Item item = items[item_index(i)];
    if ((item.what & kRelease) == 0u || store.reset != 0u) return;
    block = records[item.patch_id];
  }
  if (superblocks[superblock_of(block.position)].reclaimed != 0u) return;
  uint level = number_of(block.shape & kSidesMask);
  push(block.position, level, atomicAdd(store.counted[level], 1u));
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= store.deferred + store.events) return;
  if (kAtomicSlots) {
    push_drawing(i);
    return;
  }
  Item item = items[item_index(i)];
  if ((item.what & kRelease) == 0u || item.release_slot == kNone) return;
  uint position = i < store.deferred ? deferred_blocks[i].position : records[item.patch_id].position;
  uint level = release_level(item);
  push(position, level, tile_counts[tile_index(kReleases, level, gl_WorkGroupID.x)] + item.release_slot);
}
