#include "render/atlas/block_memory.h"

#include <algorithm>
#include <vector>

namespace atlaswire::render {
namespace {

class LevelSuperblocks final : public BlockMemory {
 public:
  LevelSuperblocks(const AllocatorSettings& s, bool stacks)
      : numbers_(s.min_block_log2, s.superblock_log2),
        grid_width_(s.atlas.width >> s.superblock_log2),
        stacks_on_(stacks),
        superblocks_(s.atlas.area() >> (2 * s.superblock_log2)) {
    LevelSuperblocks::clear();
  }

  void clear() override;
  std::optional<TexelPosition> take(Level level) override;
  void release(const Block& block) override;
  [[nodiscard]] AtlasUsage usage() const override;

 private:
  static constexpr std::uint32_t kNone = ~0U;
  struct Superblock {
    Level level;
    std::uint32_t given = 0;  ///< blocks from its start; 0: free
    std::uint32_t in_use = 0;
    std::uint32_t generation = 0;
  };
  struct Entry {
    TexelPosition at;
    std::uint32_t superblock;
    std::uint32_t generation;
  };

  [[nodiscard]] std::uint32_t capacity(Level level) const {
    return 1U << (2 * numbers_.max_log2() - level.area_log2());
  }
  std::optional<TexelPosition> pop(std::uint32_t number);

  LevelNumbers numbers_;
  std::uint32_t grid_width_;
  bool stacks_on_;
  std::vector<Superblock> superblocks_;
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> tails_;        ///< by level: superblock with room at its end
  std::vector<std::vector<Entry>> stacks_;  ///< by level; may hold entries of superblocks freed since
};

void LevelSuperblocks::clear() {
  free_.clear();
  for (auto i = static_cast<std::uint32_t>(superblocks_.size()); i-- > 0;) {
    superblocks_[i] = {.generation = superblocks_[i].generation + 1};
    free_.push_back(i);
  }
  tails_.assign(numbers_.count(), kNone);
  stacks_.assign(numbers_.count(), {});
}

std::optional<TexelPosition> LevelSuperblocks::pop(std::uint32_t number) {
  auto& stack = stacks_[number];
  while (!stack.empty()) {
    const Entry entry = stack.back();
    stack.pop_back();
    Superblock& superblock = superblocks_[entry.superblock];
    if (entry.generation != superblock.generation) continue;
    ++superblock.in_use;
    return entry.at;
  }
  return std::nullopt;
}

std::optional<TexelPosition> LevelSuperblocks::take(Level level) {
  const std::uint32_t number = numbers_.number(level);
  if (const auto at = pop(number)) return at;
  std::uint32_t& tail = tails_[number];
  if (tail == kNone) {
    if (free_.empty()) return std::nullopt;
    tail = free_.back();
    free_.pop_back();
    superblocks_[tail].level = level;
  }
  Superblock& superblock = superblocks_[tail];
  const std::uint32_t columns_log2 = numbers_.max_log2() - level.width_log2;
  const std::uint32_t column = superblock.given & ((1U << columns_log2) - 1);
  const std::uint32_t row = superblock.given >> columns_log2;
  const std::uint32_t x = ((tail % grid_width_) << numbers_.max_log2()) + (column << level.width_log2);
  const std::uint32_t y = ((tail / grid_width_) << numbers_.max_log2()) + (row << level.height_log2);
  ++superblock.given;
  ++superblock.in_use;
  if (superblock.given == capacity(level)) tail = kNone;
  return TexelPosition{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
}

void LevelSuperblocks::release(const Block& block) {
  const std::uint32_t side_log2 = numbers_.max_log2();
  const std::uint32_t i = (block.y >> side_log2) * grid_width_ + (block.x >> side_log2);
  Superblock& superblock = superblocks_[i];
  const std::uint32_t number = numbers_.number(superblock.level);
  if (--superblock.in_use == 0) {
    superblock.given = 0;
    ++superblock.generation;
    if (tails_[number] == i) tails_[number] = kNone;
    free_.push_back(i);
  } else if (stacks_on_) {
    stacks_[number].push_back({{block.x, block.y}, i, superblock.generation});
  }
}

AtlasUsage LevelSuperblocks::usage() const {
  AtlasUsage usage;
  std::uint64_t freed = 0;
  for (const Superblock& s : superblocks_) {
    if (s.given == 0) {
      usage.free += std::uint64_t{1} << (2 * numbers_.max_log2());
      continue;
    }
    usage.allocated += s.in_use * s.level.area();
    usage.partial_tail += (capacity(s.level) - s.given) * s.level.area();
    freed += (s.given - s.in_use) * s.level.area();
  }
  (stacks_on_ ? usage.on_stacks : usage.inaccessible) = freed;
  return usage;
}

}  // namespace

std::unique_ptr<BlockMemory> make_level_superblocks(const AllocatorSettings& settings, bool stacks) {
  return std::make_unique<LevelSuperblocks>(settings, stacks);
}

}  // namespace atlaswire::render
