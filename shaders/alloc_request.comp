#version 460
#extension GL_GOOGLE_include_directive : require
// Request phase ([SAS] 4.2), all patches: which of them give a block back, ask for one or change. Blocks in
// use are counted here; slots follow once it is known where every patch of the frame stands.
#include "shaders/alloc_state.glsl"

layout(local_size_x = kGroup) in;

void count_out(uint position, uint area) {
  atomicAdd(superblocks[superblock_of(position)].in_use, kNone);  // one fewer
  if (area != 0u) atomicAdd(store.allocated, 0u - area);
}

void take_part(uint patch_id, uint want, Record record, uint what, bool reset) {
  uint sides = want & kSidesMask;
  uint wanted = (record.shape >> kWantShift) & kSidesMask;
  bool known = (record.shape & kKnown) != 0u;
  if (known) atomicAdd(store.wanted[number_of(wanted)], kNone);
  if (want != 0u) atomicAdd(store.wanted[number_of(sides)], 1u);
  if ((what & kRelease) != 0u && !reset) {
    count_out(record.position, 1u << area_log2(record.shape & kSidesMask));
  }
  if (kAtomicSlots) {
    Item item = make_item(patch_id, what, want, record.shape);
    if ((what & kRequest) != 0u) item.slot = atomicAdd(store.counted[set.levels + number_of(sides)], 1u);
    if ((what & kRegrow) != 0u) item.slot = atomicAdd(store.counted[2u * set.levels + number_of(sides)], 1u);
    items[set.patches + atomicAdd(store.events, 1u)] = item;
  } else {
    atomicOr(event_count_before[event_words() + patch_id / 32u], 1u << (patch_id % 32u));
  }
}

void main() {
  bool reset = set.reset == kMustReset || (set.reset == kMayReset && store.wants_reset != 0u);
  uint i = gl_GlobalInvocationID.x;
  if (i < store.deferred && !reset) count_out(deferred_blocks[i].position, 0u);
  if (i < set.patches) {
    uint want = wants[i];
    uint shape = records[i].shape;
    uint what = classify(want, shape, reset);
    if (what != 0u) take_part(i, want, Record(records[i].position, shape), what, reset);
  }
}
