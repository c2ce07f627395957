#version 460
#extension GL_GOOGLE_include_directive : require
// One work group ends the frame: leftovers go onto the stacks, what the host reads is summed up, counters start
// anew.
#include "shaders/alloc_state.glsl"
#include "shaders/alloc_scan.glsl"

layout(local_size_x = kGroup) in;

shared uint wanted_of_width[kMostSides];

/// Returns the texels on this level's stack, in smallest blocks.
uint settle_stack(uint level) {
  uint size = store.stack_size[level];
  for (uint i = store.leftover_taken[level]; i < store.leftover_size[level]; ++i) {
    stacks[store.stack_base[level] + size] = leftovers[level * kMostLeftovers + i];
    ++size;
  }
  store.stack_size[level] = size;
  return size << area_log2(sides_of_number(level));
}

uint tail_area(uint w) {
  if (store.tail_superblock[w] == kNone) return 0u;
  return (rows_of(w) - store.tail_row[w]) << w >> (2u * set.min_log2);
}

uint saturating_add(uint sum, uint count, uint shift) {
  return min(kSaturated, sum + (count > (kSaturated >> shift) ? kSaturated : count << shift));
}

/// AtlasDemand::reset_helps.
bool reset_helps(uint visible) {
  uint superblock_log2 = 2u * (set.max_log2 - set.min_log2);
  uint total = 0u;
  uint packed = 0u;
  for (uint w = 0u; w <= set.max_log2 - set.min_log2; ++w) {
    packed += (wanted_of_width[w] + (1u << superblock_log2) - 1u) >> superblock_log2;
    total = saturating_add(total, wanted_of_width[w], 0u);
  }
  uint failed = store.refused + store.shrunken;
  if (store.reset != 0u) store.futile = failed != 0u ? total - total / 16u : kSaturated;
  uint used = set.superblocks - store.free_count;
  if (used > set.high_superblocks && packed + max(1u, set.superblocks / 32u) <= used) return true;
  if (store.shrunken != 0u && total <= set.capacity && total < store.futile) return true;
  return visible - store.refused < min(visible, set.capacity);
}

void main() {
  uint i = gl_LocalInvocationID.x;
  if (i < kMostSides) {
    uint sum = 0u;
    if (i <= set.max_log2 - set.min_log2) {
      for (uint h = 0u; h <= i; ++h) sum = saturating_add(sum, store.wanted[i * (i + 1u) / 2u + h], i + h);
    }
    wanted_of_width[i] = sum;
  }
  uint on_stacks;
  scan_group(i < set.levels ? settle_stack(i) : 0u, on_stacks);
  uint in_tails;
  scan_group(i < kMostSides && i >= set.min_log2 && i <= set.max_log2 ? tail_area(i) : 0u, in_tails);
  uint visible;
  scan_group(i < set.levels ? store.wanted[i] : 0u, visible);
  if (kAtomicSlots) {
    for (uint k = i; k < kCounters * set.levels; k += kGroup) store.counted[k] = 0u;
  }
  if (i != 0u) return;
  store.allocated -= store.grown_area;
  store.wants_reset = reset_helps(visible) ? 1u : 0u;
  report = Report(store.events, store.reset, store.wants_reset, store.allocated, in_tails,
                  on_stacks + store.grown_area,
                  store.free_count << (2u * (set.max_log2 - set.min_log2)), store.refused,
                  set.most_new != 0u ? report.waiting : 0u);
  store.deferred = store.grown;
  store.grown_area = 0u;
  store.refused = 0u;
  store.shrunken = 0u;
  if (kAtomicSlots) store.events = 0u;
}
