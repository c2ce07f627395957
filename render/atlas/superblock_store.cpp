#include "render/atlas/superblock_store.h"

#include "base/assert.h"

#include <algorithm>
#include <bit>

namespace atlaswire::render {

SuperblockStore::SuperblockStore(Extent2D atlas, std::uint32_t superblock_log2, std::uint32_t min_log2)
    : grid_{atlas.width >> superblock_log2, atlas.height >> superblock_log2},
      superblock_log2_(superblock_log2),
      min_log2_(min_log2),
      side_(superblock_log2 + 1),
      stacks_(std::size_t{side_} * side_),
      stack_size_(stacks_.size()),
      stacked_in_(grid_.area() * stacks_.size()),
      tails_(side_),
      live_(grid_.area()),
      generation_(grid_.area()) {
  AW_ASSERT(superblock_log2 <= 12 && min_log2 <= superblock_log2);
  AW_ASSERT(grid_.width << superblock_log2 == atlas.width && grid_.height << superblock_log2 == atlas.height);
  free_.reserve(live_.size());
  clear();
}

void SuperblockStore::clear() {
  for (auto& stack : stacks_) stack.clear();
  std::ranges::fill(stack_size_, 0U);
  std::ranges::fill(stacked_in_, 0U);
  std::ranges::fill(tails_, Tail{});
  std::ranges::fill(live_, 0U);
  free_.clear();
  for (std::uint32_t i = superblocks(); i-- > 0;) free_.push_back(i);
  allocated_ = 0;
}

std::optional<TexelPosition> SuperblockStore::pop(Level level) {
  const std::uint32_t slot = index(level);
  if (stack_size_[slot] == 0) return std::nullopt;
  auto& stack = stacks_[slot];
  for (;;) {
    const Entry entry = stack.back();
    stack.pop_back();
    const std::uint32_t superblock = superblock_of(entry.at);
    if (entry.generation != generation_[superblock]) continue;
    --stack_size_[slot];
    --stacked_in_[superblock * stacks_.size() + slot];
    count_live(level, entry.at);
    return entry.at;
  }
}

std::optional<TexelPosition> SuperblockStore::bump(Level level) {
  Tail& tail = tails_[level.width_log2];
  if (tail.superblock == Tail::kNone) {
    if (free_.empty()) return std::nullopt;
    tail = {free_.back(), 0};
    free_.pop_back();
  }
  const TexelPosition at = tail_position(level.width_log2);
  tail.row += 1U << level.height_log2;
  count_live(level, at);
  if (tail.row == rows(level.width_log2)) tail = {};
  return at;
}

void SuperblockStore::align_tail(std::uint32_t width_log2) {
  Tail& tail = tails_[width_log2];
  if (tail.superblock == Tail::kNone) return;
  while ((tail.row & ((1U << width_log2) - 1)) != 0) {
    const auto height_log2 = static_cast<std::uint8_t>(std::countr_zero(tail.row));
    push({static_cast<std::uint8_t>(width_log2), height_log2}, tail_position(width_log2));
    tail.row += 1U << height_log2;
  }
  if (tail.row == rows(width_log2)) tail = {};
}

std::optional<TexelPosition> SuperblockStore::take_best_fit(Level level) {
  const auto largest = static_cast<std::uint8_t>(superblock_log2_);
  std::optional<Level> best;
  const auto offer = [&](Level candidate) {
    if (!best || candidate.area_log2() < best->area_log2()) best = candidate;
  };
  for (std::uint8_t w = level.width_log2; w <= largest; ++w) {
    for (std::uint8_t h = level.height_log2; h <= w; ++h) {
      const bool in_tail = h == w && tails_[w].superblock != Tail::kNone;
      if (stack_size_[index({w, h})] != 0 || in_tail) offer({w, h});
    }
  }
  if (!best && !free_.empty()) best = Level{largest, largest};
  if (!best) return std::nullopt;

  Level whole = *best;
  auto at = pop(whole);
  if (!at) at = bump(whole);
  AW_ASSERT(at.has_value());
  allocated_ -= whole.area() - level.area();
  while (whole.height_log2 > level.height_log2) {
    --whole.height_log2;
    push(whole, {at->x, static_cast<std::uint16_t>(at->y + (1U << whole.height_log2))});
  }
  while (whole.width_log2 > level.width_log2) {
    --whole.width_log2;
    push(whole, {static_cast<std::uint16_t>(at->x + (1U << whole.width_log2)), at->y});
  }
  return at;
}

void SuperblockStore::release(const Block& block) {
  const Level level{block.width_log2, block.height_log2};
  const TexelPosition at{block.x, block.y};
  const std::uint32_t superblock = superblock_of(at);
  AW_ASSERT(live_[superblock] > 0);
  allocated_ -= level.area();
  if (--live_[superblock] == 0) {
    reclaim(superblock);
  } else {
    push(level, at);
  }
}

void SuperblockStore::reclaim(std::uint32_t superblock) {
  ++generation_[superblock];
  auto* in = &stacked_in_[superblock * stacks_.size()];
  for (std::size_t slot = 0; slot < stacks_.size(); ++slot) {
    stack_size_[slot] -= in[slot];
    in[slot] = 0;
  }
  for (Tail& tail : tails_) {
    if (tail.superblock == superblock) tail = {};
  }
  free_.push_back(superblock);
}

void SuperblockStore::push(Level level, TexelPosition at) {
  const std::uint32_t slot = index(level);
  auto& stack = stacks_[slot];
  if (stack.size() > 2 * std::size_t{stack_size_[slot]} + 64) {
    std::erase_if(stack, [&](const Entry& e) { return e.generation != generation_[superblock_of(e.at)]; });
  }
  const std::uint32_t superblock = superblock_of(at);
  stack.push_back({at, generation_[superblock]});
  ++stack_size_[slot];
  ++stacked_in_[superblock * stacks_.size() + slot];
}

void SuperblockStore::count_live(Level level, TexelPosition at) {
  ++live_[superblock_of(at)];
  allocated_ += level.area();
}

std::uint32_t SuperblockStore::superblock_of(TexelPosition at) const {
  return (std::uint32_t{at.y} >> superblock_log2_) * grid_.width + (std::uint32_t{at.x} >> superblock_log2_);
}

std::uint32_t SuperblockStore::rows(std::uint32_t width_log2) const {
  return 1U << (2 * superblock_log2_ - width_log2);
}

TexelPosition SuperblockStore::tail_position(std::uint32_t width_log2) const {
  const Tail& tail = tails_[width_log2];
  const std::uint32_t column = tail.row >> superblock_log2_;
  const std::uint32_t row = tail.row & ((1U << superblock_log2_) - 1);
  const std::uint32_t x = ((tail.superblock % grid_.width) << superblock_log2_) + (column << width_log2);
  const std::uint32_t y = ((tail.superblock / grid_.width) << superblock_log2_) + row;
  return {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
}

std::uint64_t SuperblockStore::area() const { return grid_.area() << (2 * superblock_log2_); }

AtlasUsage SuperblockStore::usage() const {
  AtlasUsage usage;
  usage.allocated = allocated_;
  usage.free = std::uint64_t{free_superblocks()} << (2 * superblock_log2_);
  for (std::uint32_t w = min_log2_; w <= superblock_log2_; ++w) {
    const Tail& tail = tails_[w];
    if (tail.superblock != Tail::kNone) usage.partial_tail += std::uint64_t{rows(w) - tail.row} << w;
    for (std::uint32_t h = min_log2_; h <= w; ++h) {
      const Level level{static_cast<std::uint8_t>(w), static_cast<std::uint8_t>(h)};
      usage.on_stacks += stacked(level) * level.area();
    }
  }
  return usage;
}

}  // namespace atlaswire::render
