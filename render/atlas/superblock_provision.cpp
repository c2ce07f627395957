// Provisioning ([SAS] 4.2): one thread's work over counts, whatever the number of blocks.
#include "base/assert.h"
#include "render/atlas/superblock_store.h"

#include <algorithm>
#include <bit>

namespace atlaswire::render {

void SuperblockStore::provision(const PerLevel& requested, std::uint32_t cap_area_log2, bool may_shrink,
                                Provision& out) {
  out.segments.clear();
  out.inflow.fill(0);
  out.may_shrink = may_shrink;
  for (std::uint32_t number = numbers_.count(); number-- > 0;) {
    Serving serving{.level = numbers_.level(number), .wanted = requested[number] + out.inflow[number]};
    out.segment[number] = static_cast<std::uint32_t>(out.segments.size());
    if (serving.wanted != 0 && serving.level.area_log2() <= cap_area_log2) serve(serving, out);
    out.served[number] = serving.served;
    allocated_ += std::uint64_t{serving.served} << serving.level.area_log2();
    if (may_shrink && number != 0 && serving.missing() != 0) {
      const std::uint32_t next = numbers_.number(halved(serving.level));
      out.onward[number] = requested[next] + out.inflow[next];
      out.inflow[next] += serving.missing();
    }
    if (serving.level.height_log2 == numbers_.min_log2()) align_tail(serving.level.width_log2);
  }
}

void SuperblockStore::serve(Serving& serving, Provision& out) {
  const Level level = serving.level;
  take_stacked(serving, level, out);
  take_tail(serving, level, out);
  take_free(serving, out);
  const std::uint32_t largest = numbers_.max_log2();
  for (std::uint32_t area = level.area_log2() + 1; area <= 2 * largest && serving.missing() != 0; ++area) {
    for (std::uint32_t w = std::max<std::uint32_t>(level.width_log2, (area + 1) / 2); w <= largest; ++w) {
      if (area < w + level.height_log2) break;
      const Level parent{std::uint8_t(w), std::uint8_t(area - w)};
      take_stacked(serving, parent, out);
      if (parent.width_log2 == parent.height_log2) take_tail(serving, parent, out);
    }
  }
}

/// Leftovers first: they are whole pieces of what was split in this very frame.
void SuperblockStore::take_stacked(Serving& serving, Level parent, Provision& out) {
  const std::uint32_t number = numbers_.number(parent);
  std::uint32_t& taken = leftover_taken_[number];
  taken +=
      take(serving, static_cast<std::uint32_t>(leftover_[number].size()) - taken,
           {.source = Provision::Source::kLeftover, .parent = std::uint8_t(number), .first = taken}, out);
  std::uint32_t& size = stack_size_[number];
  size -= take(serving, size,
               {.source = Provision::Source::kStack, .parent = std::uint8_t(number), .first = size - 1}, out);
}

void SuperblockStore::take_tail(Serving& serving, Level parent, Provision& out) {
  Tail& tail = tails_[parent.width_log2];
  if (tail.superblock == Tail::kNone) return;
  const std::uint32_t available = (rows(parent.width_log2) - tail.row) >> parent.height_log2;
  const std::uint32_t parents = take(serving, available,
                                     {.source = Provision::Source::kTail,
                                      .parent = std::uint8_t(numbers_.number(parent)),
                                      .first = tail.row,
                                      .superblock = tail.superblock},
                                     out);
  tail.row += parents << parent.height_log2;
  if (tail.row == rows(parent.width_log2)) tail = {};
}

/// Opens as many free superblocks as the level needs; the last becomes its width's tail.
void SuperblockStore::take_free(Serving& serving, Provision& out) {
  if (serving.missing() == 0 || free_count_ == 0) return;
  const Level level = serving.level;
  const std::uint32_t each_log2 = 2 * numbers_.max_log2() - level.area_log2();
  const std::uint32_t blocks = take(serving, free_count_ << each_log2,
                                    {.source = Provision::Source::kFree,
                                     .parent = std::uint8_t(numbers_.number(level)),
                                     .first = free_count_ - 1},
                                    out);
  const std::uint32_t opened = ((blocks - 1) >> each_log2) + 1;
  for (std::uint32_t i = 0; i < opened; ++i) open_[free_[free_count_ - 1 - i]] = true;
  free_count_ -= opened;
  const std::uint32_t in_last = blocks - ((opened - 1) << each_log2);
  if (in_last != 1U << each_log2) {
    tails_[level.width_log2] = {free_[free_count_], in_last << level.height_log2};
  }
}

/// Serves from up to `available` parents of a source. Returns how many it used.
std::uint32_t SuperblockStore::take(Serving& serving, std::uint32_t available, Provision::Segment segment,
                                    Provision& out) {
  if (available == 0 || serving.missing() == 0) return 0;
  const Level parent = numbers_.level(segment.parent);
  const std::uint32_t blocks_log2 = parent.area_log2() - serving.level.area_log2();
  const std::uint32_t parents = std::min(available, ((serving.missing() - 1) >> blocks_log2) + 1);
  const std::uint32_t blocks = std::min(serving.missing(), parents << blocks_log2);
  serving.served += blocks;
  segment.end = serving.served;
  out.segments.push_back(segment);
  const std::uint32_t in_last = blocks - ((parents - 1) << blocks_log2);
  if (in_last != 1U << blocks_log2) {
    keep_rest(parent_at(segment, parents - 1), parent, serving.level, in_last);
  }
  return parents;
}

/// Of a parent split into rows of blocks the first `blocks` are taken: the rest, in the largest pieces
/// that are landscape and aligned, is left over.
void SuperblockStore::keep_rest(TexelPosition at, Level parent, Level level, std::uint32_t blocks) {
  const std::uint32_t across_log2 = parent.width_log2 - level.width_log2;
  const auto keep = [&](std::uint32_t column, std::uint32_t row, Level piece) {
    leftover_[numbers_.number(piece)].push_back(
        {static_cast<std::uint16_t>(at.x + (column << level.width_log2)),
         static_cast<std::uint16_t>(at.y + (row << level.height_log2))});
  };
  const std::uint32_t across = 1U << across_log2;
  const std::uint32_t partial_row = blocks >> across_log2;
  for (std::uint32_t column = blocks & (across - 1); column != 0 && column != across;) {
    const auto step = static_cast<std::uint32_t>(std::countr_zero(column));
    keep(column, partial_row, {std::uint8_t(level.width_log2 + step), level.height_log2});
    column += 1U << step;
  }
  const std::uint32_t down = 1U << (parent.height_log2 - level.height_log2);
  for (std::uint32_t row = (blocks + across - 1) >> across_log2; row < down;) {
    const auto step = static_cast<std::uint32_t>(std::countr_zero(row));
    keep(0, row, {parent.width_log2, std::uint8_t(level.height_log2 + step)});
    row += 1U << step;
  }
}

/// Rounds the width's tail up to its tallest block; what is skipped is left over ([SAS] 4.2 (e)).
void SuperblockStore::align_tail(std::uint32_t width_log2) {
  Tail& tail = tails_[width_log2];
  if (tail.superblock == Tail::kNone) return;
  while ((tail.row & ((1U << width_log2) - 1)) != 0) {
    const auto height_log2 = static_cast<std::uint8_t>(std::countr_zero(tail.row));
    leftover_[numbers_.number({std::uint8_t(width_log2), height_log2})].push_back(
        row_at(tail.superblock, width_log2, tail.row));
    tail.row += 1U << height_log2;
  }
  if (tail.row == rows(width_log2)) tail = {};
}

}  // namespace atlaswire::render
