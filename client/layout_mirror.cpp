#include "client/layout_mirror.h"

#include "base/assert.h"
#include "client/replica.h"

#include <algorithm>
#include <utility>

namespace atlaswire::client {

LayoutMirror::LayoutMirror(const proto::AtlasMemory& memory, const Extent2D& atlas, std::uint32_t max_patches,
                           bool believes_all)
    : settings_{.atlas = atlas,
                .superblock_log2 = memory.superblock_log2,
                .min_block_log2 = memory.min_block_log2,
                .high_water = memory.high_water},
      max_patches_(max_patches),
      believes_all_(believes_all) {}

Result<codec::MetaUpdate> LayoutMirror::place(codec::MetaUpdate asked) {
  if (asked.reset) {
    asked_.clear();
    allocator_ = render::make_sequential_allocator(settings_, max_patches_);
    in_step_ = true;
  }
  if (!in_step_ || !asked.cue) return codec::MetaError::kOutOfStep;
  in_step_ = false;
  if (Result<void> taken = take_in(asked); !taken) return taken.error();
  requests_.clear();
  for (const codec::AddedPatch& patch : asked_) {
    requests_.push_back({patch.id, patch.block.width_log2, patch.block.height_log2, patch.block.transposed});
  }
  const bool resets = asked.reset || asked.cue->reset;
  if (resets) allocator_->restart();
  const render::LayoutChange& change = allocator_->update(requests_, false);
  if (resets) {
    hash_.begin(allocator_->blocks());
  } else {
    hash_.follow(change);
  }
  if (!believes_all_ && hash_.hash().upper() != asked.cue->check) {
    return Error{codec::MetaError::kOutOfStep, "the atlas's layout is not the server's"};
  }
  in_step_ = true;
  answer(change, asked);
  return asked;
}

/// The patches that ask from now on.
Result<void> LayoutMirror::take_in(codec::MetaUpdate& asked) {
  std::ranges::sort(asked.removed);
  std::ranges::sort(asked.added, {}, &codec::AddedPatch::id);
  std::ranges::sort(asked.moved, {}, &codec::MovedPatch::id);
  if (!asked.added.empty() && value(asked.added.back().id) >= max_patches_) {
    return ReplicaError::kPatchOutOfRange;
  }
  next_.clear();
  auto removed = asked.removed.begin();
  auto moved = asked.moved.begin();
  auto added = asked.added.begin();
  const auto add_below = [&](auto is_below) {
    for (; added != asked.added.end() && is_below(added->id); ++added) {
      if (!next_.empty() && next_.back().id == added->id) return false;
      next_.push_back(*added);
    }
    return true;
  };
  for (const codec::AddedPatch& known : asked_) {
    if (!add_below([&](PatchId id) { return id < known.id; })) return ReplicaError::kPatchKnown;
    if (removed != asked.removed.end() && *removed == known.id) {
      ++removed;
      // The memory would not notice that it is another patch now.
      if (added != asked.added.end() && added->id == known.id) return ReplicaError::kPatchKnown;
      continue;
    }
    next_.push_back(known);
    if (moved != asked.moved.end() && moved->id == known.id) next_.back().block = (moved++)->block;
  }
  if (!add_below([](PatchId) { return true; })) return ReplicaError::kPatchKnown;
  // What no patch answered to names patches that do not ask.
  if (removed != asked.removed.end() || moved != asked.moved.end()) return ReplicaError::kPatchUnknown;
  std::swap(asked_, next_);
  return {};
}

/// What became of the requests, in place of them.
void LayoutMirror::answer(const render::LayoutChange& change, codec::MetaUpdate& update) const {
  update.cue.reset();
  update.removed = change.removed;
  update.moved.clear();
  for (const render::PlacedPatch& placed : change.moved) update.moved.push_back({placed.patch, placed.block});
  update.added.clear();
  auto at = asked_.begin();
  for (const render::PlacedPatch& placed : change.added) {
    at = std::lower_bound(at, asked_.end(), placed.patch,
                          [](const codec::AddedPatch& a, PatchId id) { return a.id < id; });
    AW_ASSERT(at != asked_.end() && at->id == placed.patch);
    update.added.push_back(*at);
    update.added.back().block = placed.block;
  }
}

}  // namespace atlaswire::client
