#include "render/atlas/block_memory.h"

#include <set>
#include <vector>

namespace atlaswire::render {
namespace {

/// The node that a block is half of: a square is half of a node twice as wide, all else of one twice as high.
Level parent_of(Level level) {
  if (level.width_log2 == level.height_log2) return {std::uint8_t(level.width_log2 + 1), level.height_log2};
  return {level.width_log2, std::uint8_t(level.height_log2 + 1)};
}

class Quadtree final : public BlockMemory {
 public:
  explicit Quadtree(const AllocatorSettings& s)
      : numbers_(s.min_block_log2, s.superblock_log2), atlas_(s.atlas), free_(numbers_.count()) {
    Quadtree::clear();
  }

  void clear() override;
  std::optional<TexelPosition> take(Level level) override;
  void release(const Block& block) override;
  [[nodiscard]] AtlasUsage usage() const override;

 private:
  [[nodiscard]] bool is_root(Level level) const { return level.height_log2 == numbers_.max_log2(); }
  std::set<std::uint32_t>& free_of(Level level) { return free_[numbers_.number(level)]; }
  [[nodiscard]] static std::uint32_t key(TexelPosition at) { return std::uint32_t{at.y} << 16 | at.x; }
  /// The other half of `level`'s parent.
  [[nodiscard]] static TexelPosition buddy(TexelPosition at, Level level) {
    if (parent_of(level).width_log2 > level.width_log2) {
      return {static_cast<std::uint16_t>(at.x ^ (1U << level.width_log2)), at.y};
    }
    return {at.x, static_cast<std::uint16_t>(at.y ^ (1U << level.height_log2))};
  }

  LevelNumbers numbers_;
  Extent2D atlas_;
  std::vector<std::set<std::uint32_t>> free_;  ///< by level; y << 16 | x
  std::uint64_t allocated_ = 0;                ///< texels
};

void Quadtree::clear() {
  for (auto& level : free_) level.clear();
  const std::uint32_t side = 1U << numbers_.max_log2();
  const auto root = std::uint8_t(numbers_.max_log2());
  for (std::uint32_t y = 0; y < atlas_.height; y += side) {
    for (std::uint32_t x = 0; x < atlas_.width; x += side) {
      free_of({root, root}).insert(key({std::uint16_t(x), std::uint16_t(y)}));
    }
  }
  allocated_ = 0;
}

std::optional<TexelPosition> Quadtree::take(Level level) {
  Level from = level;
  while (free_of(from).empty()) {
    if (is_root(from)) return std::nullopt;
    from = parent_of(from);
  }
  auto& nodes = free_of(from);
  const std::uint32_t first = *nodes.begin();
  nodes.erase(nodes.begin());
  const TexelPosition at{static_cast<std::uint16_t>(first & 0xFFFF), static_cast<std::uint16_t>(first >> 16)};
  for (Level cut = level; cut != from; cut = parent_of(cut)) free_of(cut).insert(key(buddy(at, cut)));
  allocated_ += level.area();
  return at;
}

void Quadtree::release(const Block& block) {
  Level level{block.width_log2, block.height_log2};
  TexelPosition at{block.x, block.y};
  allocated_ -= level.area();
  while (!is_root(level)) {
    const TexelPosition other = buddy(at, level);
    auto& nodes = free_of(level);
    const auto found = nodes.find(key(other));
    if (found == nodes.end()) break;
    nodes.erase(found);
    at = {std::min(at.x, other.x), std::min(at.y, other.y)};
    level = parent_of(level);
  }
  free_of(level).insert(key(at));
}

AtlasUsage Quadtree::usage() const {
  AtlasUsage usage{.allocated = allocated_};
  for (std::uint32_t i = 0; i < numbers_.count(); ++i) {
    const Level level = numbers_.level(i);
    (is_root(level) ? usage.free : usage.on_stacks) += free_[i].size() * level.area();
  }
  return usage;
}

}  // namespace

std::unique_ptr<BlockMemory> make_quadtree(const AllocatorSettings& settings) {
  return std::make_unique<Quadtree>(settings);
}

}  // namespace atlaswire::render
