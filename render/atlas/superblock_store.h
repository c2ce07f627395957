#pragma once

#include "base/block.h"
#include "base/units.h"
#include "render/atlas/allocator.h"
#include "render/atlas/block_level.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace atlaswire::render {

/// Top left corner of a block in texels.
struct TexelPosition {
  std::uint16_t x = 0;
  std::uint16_t y = 0;
  bool operator==(const TexelPosition&) const = default;
};

/// A number for each level (LevelNumbers).
using PerLevel = std::array<std::uint32_t, LevelNumbers::kMost>;

/// What one provisioning gives: where each slot of each level's requests finds its block.
struct Provision {
  /// Where a run of blocks comes from. Parents larger than the level are split into rows of blocks.
  enum class Source : std::uint8_t {
    kStack,     ///< free blocks, `first` and downwards
    kLeftover,  ///< what this frame's splits and tails left over, `first` and upwards
    kTail,      ///< a partly filled superblock, from row `first` on
    kFree,      ///< free superblocks, `first` and downwards, filled from their first row on
  };
  struct Segment {
    std::uint32_t end = 0;  ///< slots of the level before this are in this segment or an earlier one
    Source source = Source::kStack;
    std::uint8_t parent = 0;  ///< level number of what is taken
    std::uint32_t first = 0;
    std::uint32_t superblock = 0;  ///< of kTail
  };

  PerLevel served{};   ///< slots that get a block of this level
  PerLevel inflow{};   ///< requests of larger levels that came here
  PerLevel onward{};   ///< the first unserved slot's number at the next smaller level
  PerLevel segment{};  ///< the level's first
  std::vector<Segment> segments;
  bool may_shrink = true;
};

/// The memory below an allocator ([SAS] 4.1): superblocks, cut into columns of one width, cut into blocks;
/// a stack of free blocks per level; for each width one partly filled superblock, the tail.
///
/// A frame goes `release`, `provision` (perhaps twice), `place` for each slot, `settle`. Where the paper
/// draws slots from atomic counters, slots here are numbers that the caller gives in its own order, and all
/// else follows from counts: so the layout is a function of the inputs however many threads place blocks.
///
/// Two additions to the paper. A superblock whose last block is released goes back whole, at once, and its
/// free blocks leave the stacks. And where no superblock is free, larger free blocks are split, so that no
/// free texel is out of reach; only then do columns of different width share a superblock.
class SuperblockStore {
 public:
  /// `atlas` sides are multiples of 2^superblock_log2; min_log2 <= superblock_log2 <= 12.
  SuperblockStore(Extent2D atlas, std::uint32_t superblock_log2, std::uint32_t min_log2);

  /// Everything free again.
  void clear();

  /// Gives blocks back: first those that were deferred, then these, in order. Then superblocks without a
  /// block in use become free, the last first.
  void release(std::span<const Block> blocks);
  /// A block that is no longer in use, but is released with the next frame's.
  void defer(const Block& block);

  /// Provisioning phase: finds memory for `requested` slots of each level, from the widest and highest
  /// down. A level's slots get, in this order: blocks of its stack, the rest of its width's tail, free
  /// superblocks, larger free blocks (the smallest first, split). Slots that get none go on to the next
  /// smaller level, as do all of levels above 2^cap_area_log2 texels; or, without `may_shrink`, get none.
  void provision(const PerLevel& requested, std::uint32_t cap_area_log2, bool may_shrink, Provision& out);

  struct Placed {
    Level level;
    TexelPosition at;
  };
  /// Assignment phase: the block of one slot, to be asked once; nullopt where memory did not suffice.
  std::optional<Placed> place(const Provision& provision, Level level, std::uint32_t slot);

  /// Ends the frame: leftovers go onto the stacks.
  void settle();

  [[nodiscard]] const LevelNumbers& numbers() const { return numbers_; }
  /// Free blocks on this level's stack.
  [[nodiscard]] std::uint32_t stacked(Level level) const { return stack_size_[numbers_.number(level)]; }
  [[nodiscard]] std::uint32_t superblocks() const { return static_cast<std::uint32_t>(in_use_.size()); }
  [[nodiscard]] std::uint32_t free_superblocks() const { return free_count_; }
  [[nodiscard]] std::uint64_t area() const;
  /// Texels of blocks in use, as of the last provisioning or release.
  [[nodiscard]] std::uint64_t allocated() const { return allocated_; }
  /// Counted from the structures, not from `allocated`: tests hold the sum against the area.
  [[nodiscard]] AtlasUsage usage() const;

 private:
  struct Tail {
    static constexpr std::uint32_t kNone = ~0U;
    std::uint32_t superblock = kNone;
    std::uint32_t row = 0;  ///< texel rows used, counted down one column after the other
  };

  /// Slots of one level while they find memory.
  struct Serving {
    Level level;
    std::uint32_t wanted = 0;
    std::uint32_t served = 0;
    [[nodiscard]] std::uint32_t missing() const { return wanted - served; }
  };

  void serve(Serving& serving, Provision& out);
  void take_stacked(Serving& serving, Level parent, Provision& out);
  void take_tail(Serving& serving, Level parent, Provision& out);
  void take_free(Serving& serving, Provision& out);
  std::uint32_t take(Serving& serving, std::uint32_t available, Provision::Segment segment, Provision& out);
  void keep_rest(TexelPosition at, Level parent, Level level, std::uint32_t blocks);
  void align_tail(std::uint32_t width_log2);
  [[nodiscard]] TexelPosition parent_at(const Provision::Segment& segment, std::uint32_t i) const;
  [[nodiscard]] TexelPosition row_at(std::uint32_t superblock, std::uint32_t width_log2,
                                     std::uint32_t row) const;
  std::vector<bool> reclaim();
  [[nodiscard]] std::uint32_t superblock_of(TexelPosition at) const;
  [[nodiscard]] std::uint32_t rows(std::uint32_t width_log2) const;

  Extent2D grid_;  ///< in superblocks
  LevelNumbers numbers_;
  std::vector<std::vector<TexelPosition>> stacks_;    ///< by level
  std::vector<std::uint32_t> stack_size_;             ///< by level; above it is what this frame took
  std::vector<std::vector<TexelPosition>> leftover_;  ///< by level; only within a frame
  std::vector<std::uint32_t> leftover_taken_;         ///< by level; its first ones
  std::vector<Tail> tails_;                           ///< by width
  std::vector<std::uint32_t> free_;                   ///< stack of free superblocks
  std::uint32_t free_count_ = 0;                      ///< above it is what this frame took
  std::vector<std::uint32_t> in_use_;                 ///< blocks in use, by superblock
  std::vector<bool> open_;                            ///< by superblock: not free
  std::vector<Block> deferred_;
  std::uint64_t allocated_ = 0;  ///< texels
};

}  // namespace atlaswire::render
