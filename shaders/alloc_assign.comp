#version 460
#extension GL_GOOGLE_include_directive : require
// Assignment phase ([SAS] 4.2): every item finds its block from its slot, writes its record, and tells the host.
#include "shaders/alloc_state.glsl"

layout(local_size_x = kGroup) in;

/// SuperblockStore::place. False where memory did not suffice; else `sides` and `position` become what it got.
bool place(uint round, uint slot, inout uint sides, inout uint position) {
  uint got = sides;
  uint number = number_of(got);
  while (slot >= store.rounds[round].served[number]) {
    if (round != 0u || number == 0u) return false;
    slot = store.rounds[0].onward[number] + slot - store.rounds[0].served[number];
    got = halved(got);
    number = number_of(got);
  }
  sides = got;
  uint at = store.rounds[round].segment[number];
  uint begin = 0u;
  for (; segments[at].end <= slot; ++at) begin = segments[at].end;
  Segment segment = segments[at];
  uint parent = sides_of_number(segment.source >> 8);
  uint across_log2 = width_of(parent) - width_of(sides);
  uint blocks_log2 = area_log2(parent) - area_log2(sides);
  uint piece = (slot - begin) & ((1u << blocks_log2) - 1u);
  position = parent_at(segment, (slot - begin) >> blocks_log2) +
             ((piece & ((1u << across_log2) - 1u)) << width_of(sides)) +
             ((piece >> across_log2) << (16u + height_of(sides)));
  atomicAdd(superblocks[superblock_of(position)].in_use, 1u);
  return true;
}

uint frame_slot(uint counter, Item item) {
  if (kAtomicSlots) return item.slot;
  return tile_counts[tile_index(counter, wanted_level(item), gl_WorkGroupID.x)] + item.slot;
}

/// The block that a shrunken patch leaves stays in use until the next frame's request phase.
void defer(Record old, uint level, uint slot) {
  deferred_blocks[store.outgrown_first[level] + slot] = Record(old.position, old.shape & kSidesMask);
  atomicAdd(store.grown_area, 1u << area_log2(old.shape & kSidesMask));
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < store.deferred || i >= store.deferred + store.events) return;
  Item item = items[item_index(i)];
  Record old = records[item.patch_id];
  bool held = (old.shape & kPlaced) != 0u;
  if ((item.what & kGone) != 0u) {
    records[item.patch_id] = Record(0u, 0u);
    changes[i - store.deferred] = Change(item.patch_id, held ? kRemoved : 0u, 0u);
    return;
  }
  uint mirrored = wants[item.patch_id] & kTransposed;
  uint wanted = sides_of_number(wanted_level(item));
  uint sides = wanted;
  Record now = old;
  bool placed = true;
  if ((item.what & kRequest) != 0u) {
    placed = place(0u, frame_slot(kRequests, item), sides, now.position);
  } else {
    sides = old.shape & kSidesMask;
    if ((item.what & kRegrow) != 0u) {
      uint slot = frame_slot(kRegrows, item);
      uint larger = wanted;
      if (place(1u, slot, larger, now.position)) {
        defer(old, wanted_level(item), slot);
        sides = wanted;
      }
    }
  }
  if (!placed) {
    sides = 0u;
    now.position = 0u;
    atomicAdd(store.refused, 1u);
  } else if (sides != wanted) {
    atomicAdd(store.shrunken, 1u);
  }
  now.shape = sides | mirrored | (placed ? kPlaced : 0u) | kKnown | wanted << kWantShift;
  records[item.patch_id] = now;

  const uint kBlock = kSidesMask | kTransposed;
  bool same = old.position == now.position && ((old.shape ^ now.shape) & kBlock) == 0u;
  uint what = !placed ? kRefused | (held ? kRemoved : 0u) : !held ? kAdded : same ? 0u : kMoved;
  changes[i - store.deferred] = Change(item.patch_id, what | (now.shape & kBlock) << 8, now.position);
}
