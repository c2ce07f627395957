#version 460
#extension GL_GOOGLE_include_directive : require
// One work group: where the events of each run of patches go in the list, and superblocks without a block in use freed, the
// last first; or, on a reset, everything.
#include "shaders/alloc_state.glsl"
#include "shaders/alloc_scan.glsl"

layout(local_size_x = kGroup) in;

void place_events() {
  uint words = event_words();
  uint run = (words + kGroup - 1u) / kGroup;
  uint first = min(gl_LocalInvocationID.x * run, words);
  uint end = min(first + run, words);
  uint mine = 0u;
  for (uint word = first; word < end; ++word) mine += uint(bitCount(event_count_before[words + word]));
  uint total;
  uint before = scan_group(mine, total);
  for (uint word = first; word < end; ++word) {
    event_count_before[word] = before;
    before += uint(bitCount(event_count_before[words + word]));
  }
  if (gl_LocalInvocationID.x == 0u) store.events = total;
}

/// Returns how many superblocks it freed.
uint reclaim() {
  uint count = store.free_count;
  uint before = count;
  for (uint first = 0u; first < set.superblocks; first += kGroup) {
    uint nth = first + gl_LocalInvocationID.x;
    uint i = set.superblocks - 1u - nth;
    bool mine = nth < set.superblocks && superblocks[i].open != 0u && superblocks[i].in_use == 0u;
    if (nth < set.superblocks) superblocks[i].reclaimed = mine ? 1u : 0u;
    uint total;
    uint place = scan_flag(mine, total);
    if (mine) {
      superblocks[i].open = 0u;
      superblocks[count + place].free_stack = i;
    }
    count += total;
  }
  return count - before;
}

void clear() {
  for (uint i = gl_LocalInvocationID.x; i < set.superblocks; i += kGroup) {
    superblocks[i] = Superblock(0u, 0u, 0u, set.superblocks - 1u - i);
  }
  if (gl_LocalInvocationID.x < set.levels) store.stack_size[gl_LocalInvocationID.x] = 0u;
  if (gl_LocalInvocationID.x < kMostSides) store.tail_superblock[gl_LocalInvocationID.x] = kNone;
}

void main() {
  bool reset = set.reset == kMustReset || (set.reset == kMayReset && store.wants_reset != 0u);
  uint w = gl_LocalInvocationID.x;
  uint tail = w < kMostSides ? store.tail_superblock[w] : kNone;
  bool tail_freed = tail != kNone && superblocks[tail].in_use == 0u;
  if (!kAtomicSlots) place_events();
  uint freed = 0u;
  if (reset) {
    clear();
  } else {
    freed = reclaim();
  }
  if (tail_freed) store.tail_superblock[w] = kNone;
  if (w == 0u) {
    store.reset = reset ? 1u : 0u;
    if (reset) store.allocated = 0u;
    if (reset) store.deferred = 0u;
    store.free_count = reset ? set.superblocks : store.free_count + freed;
    uint items_of_frame = store.events + store.deferred;
    store.item_groups[0] = (items_of_frame + kGroup - 1u) / kGroup;
    store.compact_groups[0] = freed != 0u ? set.levels : 0u;
  }
}
