// Bindings and arithmetic that the passes of the atlas's memory share.
#include "shaders/alloc_layout.h"

layout(push_constant) uniform Setting { Constants set; };
layout(set = 0, binding = 0, std430) buffer StoreBuffer { Store store; };
layout(set = 0, binding = 1, std430) buffer Wants { uint wants[]; };
layout(set = 0, binding = 2, std430) buffer Records { Record records[]; };
layout(set = 0, binding = 3, std430) buffer Items { Item items[]; };
layout(set = 0, binding = 4, std430) buffer Superblocks { Superblock superblocks[]; };
layout(set = 0, binding = 5, std430) buffer Stacks { uint stacks[]; };
layout(set = 0, binding = 6, std430) buffer Deferred { Record deferred_blocks[]; };
layout(set = 0, binding = 7, std430) buffer Tiles { uint tile_counts[]; };  // by tile, counter, level
layout(set = 0, binding = 8, std430) buffer Events {
  uint event_count_before[];  // by word of event bits, then the bits: one a patch that takes part in this frame
};
layout(set = 0, binding = 9, std430) buffer Segments { Segment segments[]; };
layout(set = 0, binding = 10, std430) buffer Leftovers { uint leftovers[]; };
layout(set = 0, binding = 11, std430) buffer Changes { Change changes[]; };
layout(set = 0, binding = 12, std430) buffer Reports { Report report; };

/// Slots and list places are drawn from atomic counters, as [SAS] 4.2 does: faster, but the layout then
/// depends on the order in which invocations happen to run.
layout(constant_id = 0) const bool kAtomicSlots = false;

/// Words of event bits.
uint event_words() { return (set.patches + 31u) / 32u; }

uint width_of(uint sides) { return (sides >> 4) & 15u; }
uint height_of(uint sides) { return sides & 15u; }
uint sides_of(uint width_log2, uint height_log2) { return width_log2 << 4 | height_log2; }

uint number_of(uint sides) {
  uint w = width_of(sides) - set.min_log2;
  return w * (w + 1u) / 2u + height_of(sides) - set.min_log2;
}

uint sides_of_number(uint number) {
  uint w = 0u;
  while ((w + 1u) * (w + 2u) / 2u <= number) ++w;
  return sides_of(w + set.min_log2, number - w * (w + 1u) / 2u + set.min_log2);
}

/// log2 of the area in smallest blocks.
uint area_log2(uint sides) { return width_of(sides) + height_of(sides) - 2u * set.min_log2; }

uint halved(uint sides) { return width_of(sides) > height_of(sides) ? sides - 16u : sides - 1u; }

uint superblock_of(uint position) {
  return (position >> (16u + set.max_log2)) * set.grid_width + ((position & 0xffffu) >> set.max_log2);
}

/// The position of a row of a superblock, rows counted down one column of its width after the other.
uint row_at(uint superblock, uint width_log2, uint row) {
  uint x = ((superblock % set.grid_width) << set.max_log2) + ((row >> set.max_log2) << width_log2);
  uint y = ((superblock / set.grid_width) << set.max_log2) + (row & ((1u << set.max_log2) - 1u));
  return x | y << 16;
}

uint rows_of(uint width_log2) { return 1u << (2u * set.max_log2 - width_log2); }

uint tile_index(uint counter, uint level, uint tile) {
  return (tile * kCounters + counter) * set.levels + level;
}

/// The number of the i-th parent that a segment takes blocks from, as a position.
uint parent_at(Segment segment, uint i) {
  uint number = segment.source >> 8;
  uint parent = sides_of_number(number);
  uint from = segment.source & 255u;
  if (from == kFromStack) return stacks[store.stack_base[number] + segment.first - i];
  if (from == kFromLeftover) return leftovers[number * kMostLeftovers + segment.first + i];
  if (from == kFromTail) {
    return row_at(segment.superblock, width_of(parent), segment.first + (i << height_of(parent)));
  }
  uint each_log2 = 2u * (set.max_log2 - set.min_log2) - area_log2(parent);
  uint within = i & ((1u << each_log2) - 1u);
  return row_at(superblocks[segment.first - (i >> each_log2)].free_stack, width_of(parent),
                within << height_of(parent));
}

/// What a visible, gone or unknown patch does in this frame; 0 if nothing.
uint classify(uint want, uint shape, bool reset) {
  bool known = (shape & kKnown) != 0u;
  bool held = (shape & kPlaced) != 0u;
  if (want == 0u) return !known ? 0u : kGone | (held ? kRelease : 0u);
  uint sides = want & kSidesMask;
  uint has = shape & kSidesMask;
  uint wanted = (shape >> kWantShift) & kSidesMask;
  if (!held || reset || (wanted != sides && has != sides)) return kRequest | (held ? kRelease : 0u);
  bool rewrite = ((want ^ shape) & kTransposed) != 0u || wanted != sides;
  return (has != sides ? kRegrow : 0u) | (rewrite ? kRewrite : 0u);
}

Item make_item(uint patch_id, uint what, uint want, uint shape) {
  if ((what & kRelease) != 0u) what |= number_of(shape & kSidesMask) << 8;
  if (want != 0u) what |= number_of(want & kSidesMask) << 16;
  return Item(patch_id, what, 0u, 0u);
}
/// Where the i-th item of the frame is: deferred blocks first, then patches.
uint item_index(uint i) { return i < store.deferred ? i : set.patches + i - store.deferred; }
uint release_level(Item item) { return (item.what >> 8) & 255u; }
uint wanted_level(Item item) { return (item.what >> 16) & 255u; }
