#version 460
#extension GL_GOOGLE_include_directive : require
// Slots within each tile of items: the number of items before with the same counter and level, from a bit
// mask for each. Deferred blocks come first, as items that only release.
#include "shaders/alloc_state.glsl"

layout(local_size_x = kGroup) in;

const uint kWords = kGroup / 32u;
shared uint masks[kCounters * kMostLevels * kWords];

void mark(uint counter, uint level) {
  uint i = gl_LocalInvocationID.x;
  atomicOr(masks[(counter * set.levels + level) * kWords + i / 32u], 1u << (i % 32u));
}

uint marked_before(uint counter, uint level) {
  uint i = gl_LocalInvocationID.x;
  uint first = (counter * set.levels + level) * kWords;
  uint count = uint(bitCount(masks[first + i / 32u] & ((1u << (i % 32u)) - 1u)));
  for (uint word = 0u; word < i / 32u; ++word) count += uint(bitCount(masks[first + word]));
  return count;
}

void main() {
  uint keys = kCounters * set.levels;
  for (uint k = gl_LocalInvocationID.x; k < keys * kWords; k += kGroup) masks[k] = 0u;
  barrier();

  uint i = gl_GlobalInvocationID.x;
  bool valid = i < store.deferred + store.events;
  Item item = Item(kNone, 0u, 0u, 0u);
  if (valid && i < store.deferred) {
    item.what = kRelease | number_of(deferred_blocks[i].shape & kSidesMask) << 8;
    if (superblocks[superblock_of(deferred_blocks[i].position)].reclaimed != 0u) item.what = 0u;
  } else if (valid) {
    item = items[item_index(i)];
    bool lost = store.reset != 0u;
    if (!lost && (item.what & kRelease) != 0u) {
      lost = superblocks[superblock_of(records[item.patch_id].position)].reclaimed != 0u;
    }
    // The release is still to be told, but nothing goes onto a stack.
    if (lost) item.release_slot = kNone;
  }
  bool releases = (item.what & kRelease) != 0u && item.release_slot != kNone;
  uint counter = (item.what & kRequest) != 0u ? kRequests : kRegrows;
  bool asks = (item.what & (kRequest | kRegrow)) != 0u;
  if (releases) mark(kReleases, release_level(item));
  if (asks) mark(counter, wanted_level(item));
  barrier();
  if (releases) item.release_slot = marked_before(kReleases, release_level(item));
  if (asks) item.slot = marked_before(counter, wanted_level(item));
  if (valid) items[item_index(i)] = item;
  for (uint key = gl_LocalInvocationID.x; key < keys; key += kGroup) {
    uint count = 0u;
    for (uint word = 0u; word < kWords; ++word) count += uint(bitCount(masks[key * kWords + word]));
    tile_counts[gl_WorkGroupID.x * keys + key] = count;
  }
}
