#include "render/atlas/patch_ledger.h"

#include "base/assert.h"

#include <algorithm>

namespace atlaswire::render {
namespace {

Level level_of(const Block& block) { return {block.width_log2, block.height_log2}; }

}  // namespace

void PatchLedger::advance(std::span<const BlockRequest> visible, bool reset) {
  next_.clear();
  released_.clear();
  removed_.clear();
  pending_.clear();
  old_.clear();
  shrunken_.clear();
  changed_.clear();
  wanted_.fill(0);
  requested_.fill(0);
  const auto drop = [&](const Entry& gone) {
    if (!gone.placed) return;
    released_.push_back(gone.block);
    removed_.push_back(gone.patch);
  };
  std::uint32_t old = 0;
  for (const BlockRequest& request : visible) {
    AW_ASSERT(value(request.patch) < patch_count_);
    AW_ASSERT(next_.empty() || next_.back().patch < request.patch);
    while (old < previous_.size() && previous_[old].patch < request.patch) drop(previous_[old++]);
    const bool known = old < previous_.size() && previous_[old].patch == request.patch;
    meet(request, known ? old : kNone, reset);
    if (known) ++old;
  }
  while (old < previous_.size()) drop(previous_[old++]);
}

void PatchLedger::meet(const BlockRequest& request, std::uint32_t old, bool reset) {
  const Level want = clamped({request.width_log2, request.height_log2});
  ++wanted_[numbers_.number(want)];
  const auto at = static_cast<std::uint32_t>(next_.size());
  Entry entry{.patch = request.patch, .want = want};
  const bool held = old != kNone && previous_[old].placed;
  if (held) {
    entry.block = previous_[old].block;
    const Level has = level_of(entry.block);
    // A shrunken block is kept too, until a better one is found.
    entry.placed = !reset && (previous_[old].want == want || has == want);
    if (entry.placed && has != want) shrunken_.push_back(at);
    if (!entry.placed) released_.push_back(entry.block);
    if (entry.placed && entry.block.transposed != request.transposed) changed_.push_back(at);
  }
  entry.block.transposed = request.transposed;
  if (!entry.placed) {
    pending_.push_back(at);
    old_.push_back(held ? old : kNone);
    ++requested_[numbers_.number(want)];
  }
  next_.push_back(entry);
}

void PatchLedger::place(std::uint32_t index, const SuperblockStore::Placed& placed) {
  Entry& entry = next_[index];
  if (entry.placed) changed_.push_back(index);
  entry.block.x = placed.at.x;
  entry.block.y = placed.at.y;
  entry.block.width_log2 = placed.level.width_log2;
  entry.block.height_log2 = placed.level.height_log2;
  entry.placed = true;
}

AtlasOutcome PatchLedger::report(LayoutChange& change) {
  change.added.clear();
  change.moved.clear();
  change.refused.clear();
  AtlasOutcome outcome{.reset = change.reset, .visible = static_cast<std::uint32_t>(next_.size())};
  bool lost = false;
  for (std::size_t i = 0; i < pending_.size(); ++i) {
    const Entry& entry = next_[pending_[i]];
    const bool held = old_[i] != kNone;
    if (!entry.placed) {
      change.refused.push_back(entry.patch);
      if (held) removed_.push_back(entry.patch);
      lost = lost || held;
    } else if (!held) {
      change.added.push_back({entry.patch, entry.block});
    } else if (previous_[old_[i]].block != entry.block) {
      change.moved.push_back({entry.patch, entry.block});
    }
    outcome.shrunken += entry.placed && level_of(entry.block) != entry.want ? 1 : 0;
  }
  for (const std::uint32_t i : shrunken_)
    outcome.shrunken += level_of(next_[i].block) != next_[i].want ? 1 : 0;
  outcome.refused = static_cast<std::uint32_t>(change.refused.size());
  if (lost) std::ranges::sort(removed_);
  change.removed = removed_;
  report_changed(change);
  std::swap(previous_, next_);
  return outcome;
}

void PatchLedger::report_changed(LayoutChange& change) {
  if (changed_.empty()) return;
  std::ranges::sort(changed_);
  // Clang 14 cannot read libstdc++'s ranges::unique.
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  for (const std::uint32_t i : changed_) change.moved.push_back({next_[i].patch, next_[i].block});
  std::ranges::sort(change.moved, {}, &PlacedPatch::patch);
}

Level PatchLedger::clamped(Level level) const {
  const auto low = static_cast<std::uint8_t>(numbers_.min_log2());
  const auto high = static_cast<std::uint8_t>(numbers_.max_log2());
  const auto width = std::clamp(std::max(level.width_log2, level.height_log2), low, high);
  return {width, std::clamp(std::min(level.width_log2, level.height_log2), low, width)};
}

std::vector<PlacedPatch> PatchLedger::blocks() const {
  std::vector<PlacedPatch> live;
  live.reserve(previous_.size());
  for (const Entry& entry : previous_) {
    if (entry.placed) live.push_back({entry.patch, entry.block});
  }
  return live;
}

}  // namespace atlaswire::render
