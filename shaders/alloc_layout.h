// What the passes of the atlas's memory and render/atlas_gpu share. Included by GLSL and by C++.
// The passes in their order, and what they do: render/atlas_gpu/device_store.h.
#ifndef ATLASWIRE_SHADERS_ALLOC_LAYOUT_H
#define ATLASWIRE_SHADERS_ALLOC_LAYOUT_H

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
namespace atlaswire::render::alloc {
using uint = std::uint32_t;
#define AW_CONST inline constexpr std::uint32_t
#else
#define AW_CONST const uint
#endif

/// Invocations of a work group; items of a tile.
AW_CONST kGroup = 256u;
/// Invocations of a work group over counters and levels, and of the one that provisions.
AW_CONST kKeyGroup = 32u;
/// Levels of blocks with sides from 2^0 to 2^12 (render/atlas/block_level.h numbers them).
AW_CONST kMostLevels = 91u;
AW_CONST kMostSides = 13u;
/// Leftovers of one level in a frame: each of two provisionings leaves at most one a level served, and one
/// by aligning a tail.
AW_CONST kMostLeftovers = 2u * (kMostLevels + 1u);
/// Segments of a frame. Each either exhausts its source (a stack, a tail, the free superblocks, or leftovers,
/// of which a level served makes at most 24) or is the last of its level.
AW_CONST kMostSegments = 8192u;
AW_CONST kNone = 0xffffffffu;
/// Sums of texels saturate here.
AW_CONST kSaturated = 0x7fffffffu;

/// A word of what a patch wants: 0 = hidden; else this bit, its level's sides, and whether it is mirrored.
AW_CONST kWantVisible = 0x8000u;
AW_CONST kTransposed = 0x100u;
AW_CONST kSidesMask = 0xffu;  // width_log2 << 4 | height_log2

/// A patch's shape word: sides and kTransposed of the block it has, and further bits.
AW_CONST kPlaced = 0x200u;
AW_CONST kKnown = 0x400u;   // was visible in the frame before
AW_CONST kWantShift = 16u;  // sides that it wants

/// What happens to a patch in a frame.
AW_CONST kRelease = 1u;  // its block is given back
AW_CONST kRequest = 2u;  // it asks for a block
AW_CONST kRegrow = 4u;   // it keeps a block that is smaller than wanted, and may move to a larger one
AW_CONST kRewrite = 8u;  // its record changes, though its block does not move
AW_CONST kGone = 16u;    // it is hidden now

/// Slots are counted for these, each by level.
AW_CONST kReleases = 0u;
AW_CONST kRequests = 1u;
AW_CONST kRegrows = 2u;
AW_CONST kCounters = 3u;

/// Where a run of blocks comes from (SuperblockStore's Provision::Source).
AW_CONST kFromStack = 0u;
AW_CONST kFromLeftover = 1u;
AW_CONST kFromTail = 2u;
AW_CONST kFromFree = 3u;

/// What a frame did to a patch.
AW_CONST kAdded = 1u;
AW_CONST kMoved = 2u;
AW_CONST kRemoved = 4u;
AW_CONST kRefused = 8u;

/// Whether a frame resets.
AW_CONST kMayReset = 1u;  // if memory asks for it
AW_CONST kMustReset = 2u;

/// Push constants of every pass. Areas are counted in smallest blocks.
struct Constants {
  uint patches;
  uint reset;  // 0: not in this frame
  uint levels;
  uint min_log2;
  uint max_log2;    // of blocks, and the superblock's side
  uint grid_width;  // in superblocks
  uint superblocks;
  uint high_superblocks;  // AtlasDemand
  uint capacity;          // the atlas's area
  uint regrow_limit;
  uint most_new;  // patches never admitted before that a frame admits
};

/// A patch's place in the atlas.
struct Record {
  uint position;  // x | y << 16, texels
  uint shape;
};

/// A patch, or a deferred block, that takes part in this frame.
struct Item {
  uint patch_id;
  uint what;          // k... flags, level number of the block released << 8, of the block asked for << 16
  uint release_slot;  // within the tile
  uint slot;
};

/// One superblock, and one entry of the stack of free ones.
struct Superblock {
  uint in_use;  // blocks
  uint open;    // not free
  uint reclaimed;
  uint free_stack;
};

struct Segment {
  uint end;
  uint source;  // | parent's level number << 8
  uint first;
  uint superblock;
};

/// One provisioning, by level.
struct Round {
  uint served[91];
  uint onward[91];
  uint segment[91];
};

/// The memory's state, and a frame's counters.
struct Store {
  uint item_groups[4];     // VkDispatchIndirectCommand over items
  uint compact_groups[4];  // the same over levels; none unless superblocks came back
  uint events;             // items without the deferred blocks
  uint deferred;
  uint reset;
  uint wants_reset;
  uint futile;
  uint free_count;
  uint allocated;
  uint refused;
  uint shrunken;
  uint grown;
  uint grown_area;  // of the blocks outgrown
  uint padding;
  uint wanted[91];
  uint counted[273];  // slots, by counter and level
  uint stack_base[91];
  uint stack_size[91];
  uint leftover_size[91];
  uint leftover_taken[91];
  uint outgrown_first[91];
  uint tail_superblock[13];
  uint tail_row[13];
  Round rounds[2];
};

/// One line of the change list. A patch without any change may have one too, with what = 0.
struct Change {
  uint patch_id;
  uint what;  // k... flags, and the block's shape << 8
  uint position;
};

/// What the host reads first. Areas in smallest blocks.
struct Report {
  uint changes;
  uint reset;
  uint wants_reset;
  uint allocated;
  uint partial_tail;
  uint on_stacks;
  uint free_area;
  uint refused;
  uint waiting;  // patches that were not admitted
};

#undef AW_CONST
#ifdef __cplusplus
static_assert(sizeof(Constants) == 44 && sizeof(Record) == 8 && sizeof(Item) == 16);
static_assert(sizeof(Superblock) == 16 && sizeof(Segment) == 16 && sizeof(Change) == 12);
static_assert(offsetof(Store, events) == 32 && offsetof(Store, wanted) == 80);
static_assert(sizeof(Round) == 3 * 91 * 4 && sizeof(Report) == 36);
static_assert(offsetof(Store, rounds) == 80 + 4 * (91 * 9 + 26));
}  // namespace atlaswire::render::alloc
#endif

#endif  // ATLASWIRE_SHADERS_ALLOC_LAYOUT_H
