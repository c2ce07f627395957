#include "render/atlas/patch_ledger.h"

#include "base/assert.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <utility>

namespace atlaswire::render {
namespace {

Level level_of(const Block& block) { return {block.width_log2, block.height_log2}; }

bool is_shrunken(const PatchLedger::Entry& entry) {
  return entry.placed && level_of(entry.block) != entry.want;
}

bool comes_before(const PlacedPatch& a, const PlacedPatch& b) { return a.patch < b.patch; }

}  // namespace

void PatchLedger::advance(std::span<const BlockRequest> visible, bool reset) {
  listed_.clear();
  gone_.clear();
  asked_.clear();
  std::uint32_t least = 0;
  for (const BlockRequest& request : visible) {
    AW_ASSERT(value(request.patch) >= least && value(request.patch) < patch_count_);
    least = value(request.patch) + 1;
    listed_.insert(request.patch);
    if (!stands(request)) asked_.push_back(request);
  }
  asking_.for_each_not_in(listed_, [&](PatchId patch) { gone_.push_back(patch); });
  advance(RequestChange{gone_, asked_}, reset);
}

void PatchLedger::advance(const RequestChange& change, bool reset) {
  AW_ASSERT(std::ranges::adjacent_find(change.gone, std::greater_equal{}) == change.gone.end());
  AW_ASSERT(std::ranges::adjacent_find(change.asked, std::greater_equal{}, &BlockRequest::patch) ==
            change.asked.end());
  begin_frame();
  auto gone = change.gone.begin();
  for (const BlockRequest& request : change.asked) {
    while (gone != change.gone.end() && *gone < request.patch) drop(*gone++);
    AW_ASSERT(gone == change.gone.end() || *gone != request.patch);
    meet(request, reset);
  }
  while (gone != change.gone.end()) drop(*gone++);
  if (reset) {
    unplace_all();
  } else {
    retry_refused();
  }
  forget_grown();
  for (const PatchId patch : pending_) ++requested_[numbers_.number(entry(patch).want)];
}

void PatchLedger::begin_frame() {
  released_.clear();
  removed_.clear();
  pending_.clear();
  requested_.fill(0);
  outdated_.clear();
  changed_.clear();
}

void PatchLedger::drop(PatchId patch) {
  AW_ASSERT(asking_.contains(patch));
  Entry& entry = entries_[value(patch)];
  if (entry.placed) {
    released_.push_back(entry.block);
    removed_.push_back(patch);
  }
  entry.placed = false;
  asking_.erase(patch);
  --asking_count_;
  --wanted_[numbers_.number(entry.want)];
}

void PatchLedger::meet(const BlockRequest& request, bool reset) {
  const PatchId patch = request.patch;
  AW_ASSERT(value(patch) < patch_count_);
  if (value(patch) >= entries_.size()) entries_.resize(value(patch) + 1);
  Entry& entry = entries_[value(patch)];
  if (asking_.contains(patch)) {
    --wanted_[numbers_.number(entry.want)];
  } else {
    asking_.insert(patch);
    ++asking_count_;
  }
  const Level want = wanted_by(request);
  ++wanted_[numbers_.number(want)];
  if (entry.placed) {
    // A shrunken block is kept too, until a better one is found.
    const bool keeps = !reset && (entry.want == want || level_of(entry.block) == want);
    if (keeps && entry.block.transposed != request.transposed) changed_.push_back(patch);
    if (!keeps) {
      released_.push_back(entry.block);
      outdated_.push_back({patch, entry.block});
    }
    entry.placed = keeps;
  }
  entry.want = want;
  entry.block.transposed = request.transposed;
  if (!entry.placed) pending_.push_back(patch);
}

/// A reset: everybody who asks is pending, whether met in this frame or not.
void PatchLedger::unplace_all() {
  released_.clear();
  pending_.clear();
  const auto met = static_cast<std::ptrdiff_t>(outdated_.size());
  asking_.for_each([&](PatchId patch) {
    Entry& entry = entries_[value(patch)];
    if (entry.placed) outdated_.push_back({patch, entry.block});
    entry.placed = false;
    pending_.push_back(patch);
  });
  std::inplace_merge(outdated_.begin(), outdated_.begin() + met, outdated_.end(), comes_before);
}

/// Whom the frame before refused, unless it went, is pending again.
void PatchLedger::retry_refused() {
  std::erase_if(refused_, [&](PatchId patch) { return !asking_.contains(patch); });
  if (refused_.empty()) return;
  merged_.clear();
  std::set_union(pending_.begin(), pending_.end(), refused_.begin(), refused_.end(),
                 std::back_inserter(merged_));
  std::swap(pending_, merged_);
}

void PatchLedger::forget_grown() {
  std::erase_if(shrunken_, [&](PatchId patch) { return !is_shrunken(entry(patch)); });
}

void PatchLedger::place(PatchId patch, const SuperblockStore::Placed& placed) {
  Entry& entry = entries_[value(patch)];
  if (entry.placed) changed_.push_back(patch);
  entry.block.x = placed.at.x;
  entry.block.y = placed.at.y;
  entry.block.width_log2 = placed.level.width_log2;
  entry.block.height_log2 = placed.level.height_log2;
  entry.placed = true;
}

AtlasOutcome PatchLedger::report(LayoutChange& change) {
  forget_grown();
  report_pending(change);
  report_changed(change);
  change.removed = removed_;
  change.refused = refused_;
  return {.reset = change.reset,
          .visible = asking_count_,
          .refused = static_cast<std::uint32_t>(refused_.size()),
          .shrunken = static_cast<std::uint32_t>(shrunken_.size())};
}

/// What became of the pending: added, moved, refused, and shrunken beside those that were before.
void PatchLedger::report_pending(LayoutChange& change) {
  change.added.clear();
  change.moved.clear();
  refused_.clear();
  const auto kept = static_cast<std::ptrdiff_t>(shrunken_.size());
  const auto gone = static_cast<std::ptrdiff_t>(removed_.size());
  auto outdated = outdated_.begin();
  for (const PatchId patch : pending_) {
    const Entry& now = entry(patch);
    const bool held = outdated != outdated_.end() && outdated->patch == patch;
    if (!now.placed) {
      refused_.push_back(patch);
      if (held) removed_.push_back(patch);
    } else if (!held) {
      change.added.push_back({patch, now.block});
    } else if (outdated->block != now.block) {
      change.moved.push_back({patch, now.block});
    }
    if (is_shrunken(now)) shrunken_.push_back(patch);
    if (held) ++outdated;
  }
  std::inplace_merge(removed_.begin(), removed_.begin() + gone, removed_.end());
  std::inplace_merge(shrunken_.begin(), shrunken_.begin() + kept, shrunken_.end());
}

void PatchLedger::report_changed(LayoutChange& change) {
  if (changed_.empty()) return;
  std::ranges::sort(changed_);
  // Clang 14 cannot read libstdc++'s ranges::unique.
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  const auto placed = static_cast<std::ptrdiff_t>(change.moved.size());
  for (const PatchId patch : changed_) change.moved.push_back({patch, entry(patch).block});
  std::inplace_merge(change.moved.begin(), change.moved.begin() + placed, change.moved.end(), comes_before);
}

bool PatchLedger::stands(const BlockRequest& request) const {
  if (!asking_.contains(request.patch)) return false;
  const Entry& known = entry(request.patch);
  if (known.block.transposed != request.transposed) return false;
  // Most requests are legal as they are.
  return known.want == Level{request.width_log2, request.height_log2} || known.want == wanted_by(request);
}

Level PatchLedger::wanted_by(const BlockRequest& request) const {
  const auto low = static_cast<std::uint8_t>(numbers_.min_log2());
  const auto high = static_cast<std::uint8_t>(numbers_.max_log2());
  const auto width = std::clamp(std::max(request.width_log2, request.height_log2), low, high);
  return {width, std::clamp(std::min(request.width_log2, request.height_log2), low, width)};
}

std::vector<PlacedPatch> PatchLedger::blocks() const {
  std::vector<PlacedPatch> live;
  live.reserve(asking_count_);
  asking_.for_each([&](PatchId patch) {
    if (entry(patch).placed) live.push_back({patch, entry(patch).block});
  });
  return live;
}

}  // namespace atlaswire::render
