#include "client/layout_mirror.h"

#include "base/assert.h"
#include "client/replica.h"

#include <algorithm>
#include <functional>

namespace atlaswire::client {
namespace {

/// Decoders give ascending lists, but need not.
template <class List, class Key>
void sort_by(List& list, Key key) {
  if (!std::ranges::is_sorted(list, {}, key)) std::ranges::sort(list, {}, key);
}

template <class List, class Key>
bool has_twice(const List& list, Key key) {
  return std::ranges::adjacent_find(list, {}, key) != list.end();
}

void sort_lists(codec::MetaUpdate& asked) {
  sort_by(asked.removed, std::identity{});
  sort_by(asked.added, &codec::AddedPatch::id);
  sort_by(asked.moved, &codec::MovedPatch::id);
}

}  // namespace

LayoutMirror::LayoutMirror(const proto::AtlasMemory& memory, const Extent2D& atlas, std::uint32_t max_patches,
                           bool believes_all)
    : max_patches_(max_patches),
      believes_all_(believes_all),
      allocator_(render::make_sequential_allocator({.atlas = atlas,
                                                    .superblock_log2 = memory.superblock_log2,
                                                    .min_block_log2 = memory.min_block_log2,
                                                    .high_water = memory.high_water},
                                                   max_patches)) {}

Result<codec::MetaUpdate> LayoutMirror::place(codec::MetaUpdate asked) {
  if (asked.reset) {
    forget_all();
    in_step_ = true;
  }
  if (!in_step_ || !asked.cue) return codec::MetaError::kOutOfStep;
  in_step_ = false;
  sort_lists(asked);
  if (Result<void> fine = check(asked); !fine) return fine.error();
  take_in(asked);
  const bool resets = asked.reset || asked.cue->reset;
  if (resets) allocator_->restart();
  const render::LayoutChange& change = allocator_->update_by({asked.removed, requests_}, false);
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

Result<void> LayoutMirror::check(const codec::MetaUpdate& asked) const {
  if (!asked.added.empty() && value(asked.added.back().id) >= max_patches_) {
    return ReplicaError::kPatchOutOfRange;
  }
  // Not even one that is removed here: the memory would not notice that it is another patch now.
  const auto is_known = [&](const codec::AddedPatch& patch) { return asks(patch.id); };
  if (std::ranges::any_of(asked.added, is_known) || has_twice(asked.added, &codec::AddedPatch::id)) {
    return ReplicaError::kPatchKnown;
  }
  const auto is_unknown = [&](PatchId patch) { return !asks(patch); };
  if (std::ranges::any_of(asked.removed, is_unknown) || has_twice(asked.removed, std::identity{})) {
    return ReplicaError::kPatchUnknown;
  }
  if (has_twice(asked.moved, &codec::MovedPatch::id)) return ReplicaError::kPatchUnknown;
  auto removed = asked.removed.begin();
  for (const codec::MovedPatch& patch : asked.moved) {
    while (removed != asked.removed.end() && *removed < patch.id) ++removed;
    const bool goes = removed != asked.removed.end() && *removed == patch.id;
    if (goes || !asks(patch.id)) return ReplicaError::kPatchUnknown;
  }
  return {};
}

/// Who asks from now on, and what the memory must be told.
void LayoutMirror::take_in(const codec::MetaUpdate& asked) {
  requests_.clear();
  const auto request = [&](PatchId patch, const Block& block) {
    requests_.push_back({patch, block.width_log2, block.height_log2, block.transposed});
  };
  for (const PatchId patch : asked.removed) remove(patch);
  auto moved = asked.moved.begin();
  for (const codec::AddedPatch& patch : asked.added) {
    for (; moved != asked.moved.end() && moved->id < patch.id; ++moved) request(moved->id, moved->block);
    request(patch.id, patch.block);
    add(patch);
  }
  for (; moved != asked.moved.end(); ++moved) request(moved->id, moved->block);
}

/// What became of the requests, in place of them.
void LayoutMirror::answer(const render::LayoutChange& change, codec::MetaUpdate& update) const {
  update.cue.reset();
  update.removed = change.removed;
  update.moved.clear();
  for (const render::PlacedPatch& placed : change.moved) update.moved.push_back({placed.patch, placed.block});
  update.added.clear();
  for (const render::PlacedPatch& placed : change.added) {
    AW_ASSERT(asks(placed.patch));
    update.added.push_back(asking_[slot_[value(placed.patch)] - 1]);
    update.added.back().block = placed.block;
  }
}

bool LayoutMirror::asks(PatchId patch) const {
  return value(patch) < slot_.size() && slot_[value(patch)] != 0;
}

void LayoutMirror::add(const codec::AddedPatch& patch) {
  if (value(patch.id) >= slot_.size()) slot_.resize(value(patch.id) + 1);
  asking_.push_back(patch);
  slot_[value(patch.id)] = static_cast<std::uint32_t>(asking_.size());
}

void LayoutMirror::remove(PatchId patch) {
  const std::uint32_t slot = slot_[value(patch)];
  asking_[slot - 1] = asking_.back();
  slot_[value(asking_.back().id)] = slot;
  asking_.pop_back();
  slot_[value(patch)] = 0;
}

/// The memory is emptied too, and restarted after: it then lays out as a new one would.
void LayoutMirror::forget_all() {
  for (const codec::AddedPatch& patch : asking_) slot_[value(patch.id)] = 0;
  asking_.clear();
  allocator_->update({}, false);
}

}  // namespace atlaswire::client
