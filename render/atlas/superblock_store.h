#pragma once

#include "base/block.h"
#include "base/units.h"
#include "render/atlas/allocator.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace atlaswire::render {

/// Binary logarithms of a block's sides; landscape: width_log2 >= height_log2 ([SAS] 4.3 calls it level).
struct Level {
  std::uint8_t width_log2 = 0;
  std::uint8_t height_log2 = 0;
  bool operator==(const Level&) const = default;
  /// log2 of the area in texels.
  [[nodiscard]] std::uint32_t area_log2() const { return std::uint32_t{width_log2} + height_log2; }
  [[nodiscard]] std::uint64_t area() const { return std::uint64_t{1} << area_log2(); }
};

/// Half the area, still landscape: the longer side halves, of a square the height.
constexpr Level halved(Level level) {
  if (level.width_log2 > level.height_log2) return {std::uint8_t(level.width_log2 - 1), level.height_log2};
  return {level.width_log2, std::uint8_t(level.height_log2 - 1)};
}

/// Top left corner of a block in texels.
struct TexelPosition {
  std::uint16_t x = 0;
  std::uint16_t y = 0;
};

/// The memory below an allocator ([SAS] 4.1): superblocks, cut into columns of one width, cut into blocks;
/// a stack of free blocks per level; for each width one partly filled superblock, the tail.
/// Two additions to the paper. A superblock whose last block is released goes back whole, at once, and
/// its entries on the stacks die (a generation number tells). And `take_best_fit` may split a larger free
/// block, so that no free texel is out of reach; only then do columns of different width share a superblock.
class SuperblockStore {
 public:
  /// `atlas` sides are multiples of 2^superblock_log2; min_log2 <= superblock_log2 <= 12.
  SuperblockStore(Extent2D atlas, std::uint32_t superblock_log2, std::uint32_t min_log2);

  /// Everything free again.
  void clear();

  /// Free blocks on this level's stack.
  [[nodiscard]] std::uint32_t stacked(Level level) const { return stack_size_[index(level)]; }
  /// The newest free block of exactly this level.
  std::optional<TexelPosition> pop(Level level);
  /// The next block of the width's tail, opening a superblock when it is full. Within one provisioning of
  /// a width heights must not increase; then call `align_tail`.
  std::optional<TexelPosition> bump(Level level);
  /// Rounds the width's tail up to its tallest block; what is skipped goes onto the stacks ([SAS] 4.2 (e)).
  void align_tail(std::uint32_t width_log2);
  /// The smallest free block that holds `level`, split down to it. Tails must be aligned.
  std::optional<TexelPosition> take_best_fit(Level level);
  /// Gives a block back.
  void release(const Block& block);

  [[nodiscard]] std::uint32_t superblocks() const { return static_cast<std::uint32_t>(live_.size()); }
  [[nodiscard]] std::uint32_t free_superblocks() const { return static_cast<std::uint32_t>(free_.size()); }
  [[nodiscard]] std::uint64_t area() const;
  [[nodiscard]] std::uint64_t allocated() const { return allocated_; }
  /// Counted from the structures, not from `allocated`: tests hold the sum against the area.
  [[nodiscard]] AtlasUsage usage() const;

 private:
  struct Entry {
    TexelPosition at;
    std::uint32_t generation;
  };
  struct Tail {
    static constexpr std::uint32_t kNone = ~0U;
    std::uint32_t superblock = kNone;
    std::uint32_t row = 0;  ///< texel rows used, counted down one column after the other
  };

  [[nodiscard]] std::uint32_t index(Level level) const {
    return level.width_log2 * side_ + level.height_log2;
  }
  [[nodiscard]] std::uint32_t superblock_of(TexelPosition at) const;
  [[nodiscard]] std::uint32_t rows(std::uint32_t width_log2) const;
  [[nodiscard]] TexelPosition tail_position(std::uint32_t width_log2) const;
  void push(Level level, TexelPosition at);
  void count_live(Level level, TexelPosition at);
  void reclaim(std::uint32_t superblock);

  Extent2D grid_;  ///< in superblocks
  std::uint32_t superblock_log2_;
  std::uint32_t min_log2_;
  std::uint32_t side_;                      ///< levels along one side of the level tables
  std::vector<std::vector<Entry>> stacks_;  ///< by level; may hold entries of dead generations
  std::vector<std::uint32_t> stack_size_;   ///< by level; living entries only
  std::vector<std::uint32_t> stacked_in_;   ///< by superblock, then level
  std::vector<Tail> tails_;                 ///< by width
  std::vector<std::uint32_t> free_;         ///< stack of free superblocks
  std::vector<std::uint32_t> live_;         ///< blocks in use, by superblock
  std::vector<std::uint32_t> generation_;   ///< by superblock
  std::uint64_t allocated_ = 0;             ///< texels
};

}  // namespace atlaswire::render
