#include "render/atlas/superblock_store.h"

#include "base/assert.h"

#include <algorithm>

namespace atlaswire::render {

SuperblockStore::SuperblockStore(Extent2D atlas, std::uint32_t superblock_log2, std::uint32_t min_log2)
    : grid_{atlas.width >> superblock_log2, atlas.height >> superblock_log2},
      numbers_(min_log2, superblock_log2),
      stacks_(numbers_.count()),
      stack_size_(numbers_.count()),
      leftover_(numbers_.count()),
      leftover_taken_(numbers_.count()),
      tails_(superblock_log2 + 1),
      free_(grid_.area()),
      in_use_(grid_.area()),
      open_(grid_.area()) {
  AW_ASSERT(superblock_log2 <= 12 && min_log2 <= superblock_log2);
  AW_ASSERT(grid_.width << superblock_log2 == atlas.width && grid_.height << superblock_log2 == atlas.height);
  clear();
}

void SuperblockStore::clear() {
  for (auto& stack : stacks_) stack.clear();
  std::ranges::fill(stack_size_, 0U);
  std::ranges::fill(tails_, Tail{});
  std::ranges::fill(in_use_, 0U);
  std::fill(open_.begin(), open_.end(), false);
  deferred_.clear();
  free_count_ = superblocks();
  for (std::uint32_t i = 0; i < free_count_; ++i) free_[i] = free_count_ - 1 - i;
  allocated_ = 0;
}

void SuperblockStore::release(std::span<const Block> blocks) {
  const auto count_out = [&](const Block& block) {
    const std::uint32_t superblock = superblock_of({block.x, block.y});
    AW_ASSERT(in_use_[superblock] > 0);
    --in_use_[superblock];
  };
  for (const Block& block : deferred_) count_out(block);
  for (const Block& block : blocks) {
    count_out(block);
    allocated_ -= block.area();
  }
  const std::vector<bool> reclaimed = reclaim();
  const auto push = [&](const Block& block) {
    const TexelPosition at{block.x, block.y};
    if (!reclaimed.empty() && reclaimed[superblock_of(at)]) return;
    const std::uint32_t number = numbers_.number({block.width_log2, block.height_log2});
    stacks_[number].push_back(at);
    ++stack_size_[number];
  };
  std::ranges::for_each(deferred_, push);
  std::ranges::for_each(blocks, push);
  deferred_.clear();
}

void SuperblockStore::defer(const Block& block) {
  deferred_.push_back(block);
  allocated_ -= block.area();
}

/// Frees superblocks without a block in use, and says which; empty if none.
std::vector<bool> SuperblockStore::reclaim() {
  std::vector<bool> reclaimed;
  for (std::uint32_t i = superblocks(); i-- > 0;) {
    if (!open_[i] || in_use_[i] != 0) continue;
    if (reclaimed.empty()) reclaimed.resize(superblocks());
    reclaimed[i] = true;
    open_[i] = false;
    free_[free_count_++] = i;
  }
  if (reclaimed.empty()) return reclaimed;
  for (Tail& tail : tails_) {
    if (tail.superblock != Tail::kNone && reclaimed[tail.superblock]) tail = {};
  }
  for (std::size_t i = 0; i < stacks_.size(); ++i) {
    std::erase_if(stacks_[i], [&](TexelPosition at) { return reclaimed[superblock_of(at)]; });
    stack_size_[i] = static_cast<std::uint32_t>(stacks_[i].size());
  }
  return reclaimed;
}

std::optional<SuperblockStore::Placed> SuperblockStore::place(const Provision& provision, Level level,
                                                              std::uint32_t slot) {
  std::uint32_t number = numbers_.number(level);
  while (slot >= provision.served[number]) {
    if (!provision.may_shrink || number == 0) return std::nullopt;
    slot = provision.onward[number] + slot - provision.served[number];
    level = halved(level);
    number = numbers_.number(level);
  }
  const Provision::Segment* segment = &provision.segments[provision.segment[number]];
  std::uint32_t begin = 0;
  for (; segment->end <= slot; ++segment) begin = segment->end;

  const Level parent = numbers_.level(segment->parent);
  const std::uint32_t across_log2 = parent.width_log2 - level.width_log2;
  const std::uint32_t blocks_log2 = parent.area_log2() - level.area_log2();
  const std::uint32_t i = slot - begin;
  TexelPosition at = parent_at(*segment, i >> blocks_log2);
  const std::uint32_t piece = i & ((1U << blocks_log2) - 1);
  at.x = static_cast<std::uint16_t>(at.x + ((piece & ((1U << across_log2) - 1)) << level.width_log2));
  at.y = static_cast<std::uint16_t>(at.y + ((piece >> across_log2) << level.height_log2));
  ++in_use_[superblock_of(at)];
  return Placed{level, at};
}

TexelPosition SuperblockStore::parent_at(const Provision::Segment& segment, std::uint32_t i) const {
  const Level parent = numbers_.level(segment.parent);
  switch (segment.source) {
    case Provision::Source::kStack:
      return stacks_[segment.parent][segment.first - i];
    case Provision::Source::kLeftover:
      return leftover_[segment.parent][segment.first + i];
    case Provision::Source::kTail:
      return row_at(segment.superblock, parent.width_log2, segment.first + (i << parent.height_log2));
    case Provision::Source::kFree:
      break;
  }
  const std::uint32_t each_log2 = 2 * numbers_.max_log2() - parent.area_log2();
  const std::uint32_t in = i & ((1U << each_log2) - 1);
  return row_at(free_[segment.first - (i >> each_log2)], parent.width_log2, in << parent.height_log2);
}

void SuperblockStore::settle() {
  for (std::size_t i = 0; i < stacks_.size(); ++i) {
    stacks_[i].resize(stack_size_[i]);
    const auto first = leftover_[i].begin() + leftover_taken_[i];
    stacks_[i].insert(stacks_[i].end(), first, leftover_[i].end());
    stack_size_[i] = static_cast<std::uint32_t>(stacks_[i].size());
    leftover_[i].clear();
    leftover_taken_[i] = 0;
  }
}

TexelPosition SuperblockStore::row_at(std::uint32_t superblock, std::uint32_t width_log2,
                                      std::uint32_t row) const {
  const std::uint32_t side_log2 = numbers_.max_log2();
  const std::uint32_t x = ((superblock % grid_.width) << side_log2) + ((row >> side_log2) << width_log2);
  const std::uint32_t y = ((superblock / grid_.width) << side_log2) + (row & ((1U << side_log2) - 1));
  return {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)};
}

std::uint32_t SuperblockStore::superblock_of(TexelPosition at) const {
  const std::uint32_t side_log2 = numbers_.max_log2();
  return (std::uint32_t{at.y} >> side_log2) * grid_.width + (std::uint32_t{at.x} >> side_log2);
}

std::uint32_t SuperblockStore::rows(std::uint32_t width_log2) const {
  return 1U << (2 * numbers_.max_log2() - width_log2);
}

std::uint64_t SuperblockStore::area() const { return grid_.area() << (2 * numbers_.max_log2()); }

AtlasUsage SuperblockStore::usage() const {
  AtlasUsage usage;
  usage.allocated = allocated_;
  usage.free = std::uint64_t{free_count_} << (2 * numbers_.max_log2());
  for (std::uint32_t w = numbers_.min_log2(); w <= numbers_.max_log2(); ++w) {
    const Tail& tail = tails_[w];
    if (tail.superblock != Tail::kNone) usage.partial_tail += std::uint64_t{rows(w) - tail.row} << w;
  }
  for (std::uint32_t i = 0; i < numbers_.count(); ++i) {
    usage.on_stacks += std::uint64_t{stack_size_[i]} << numbers_.level(i).area_log2();
  }
  for (const Block& block : deferred_) usage.on_stacks += block.area();
  return usage;
}

}  // namespace atlaswire::render
