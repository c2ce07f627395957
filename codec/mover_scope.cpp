#include "codec/mover_scope.h"

#include "base/assert.h"

#include <algorithm>

namespace atlaswire::codec {

namespace {

std::uint64_t key_of(const GridPosition& at) {
  return std::uint64_t{at.x} | std::uint64_t{at.y} << 20U | std::uint64_t{at.z} << 40U;
}

void list_used(const std::vector<std::uint32_t>& uses, std::vector<std::uint32_t>& out) {
  out.clear();
  for (std::uint32_t i = 0; i < uses.size(); ++i) {
    if (uses[i] != 0) out.push_back(i);
  }
}

}  // namespace

MoverScope::MoverScope(std::span<const Mover> movers, std::uint64_t seed)
    : movers_(movers.begin(), movers.end()), seed_(seed), numbers_(seed) {
  forget();
}

void MoverScope::forget() {
  surface_.clear();
  ids_.clear();
  shown_.clear();
  std::uint32_t objects = 0;
  for (const Mover& mover : movers_) {
    if (!mover.deforms) objects = std::max(objects, mover.object + 1);
  }
  seen_.assign(objects, 0);
  positions_.assign(movers_.size(), FlatIndex(seed_));
  numbers_.clear();
  patches_.clear();
}

void MoverScope::follow(const MoverChange& change) {
  if (change.reset) forget();
  for (const PatchId id : change.gone) {
    const std::uint32_t number = numbers_.find(value(id));
    if (number != FlatIndex::kNone) hide(patches_[number]);
  }
  for (const MoverPatch& patch : change.come) come(patch);
  list_used(shown_, vertices_);
  list_used(seen_, objects_);
}

void MoverScope::hide(Patch& patch) {
  if (!patch.visible) return;
  patch.visible = false;
  const Mover& mover = movers_[patch.mover];
  if (!mover.deforms) --seen_[mover.object];
  for (std::uint32_t c = 0; c < patch.count; ++c) --shown_[patch.corners[c]];
}

void MoverScope::come(const MoverPatch& told) {
  AW_ASSERT(told.mover < movers_.size());
  std::uint32_t number = numbers_.find(value(told.id));
  if (number == FlatIndex::kNone) {
    number = static_cast<std::uint32_t>(patches_.size());
    numbers_.insert(value(told.id), number);
    patches_.emplace_back();
  }
  Patch& patch = patches_[number];
  hide(patch);
  patch.mover = told.mover;
  patch.count = told.count;
  for (std::uint32_t c = 0; c < told.count; ++c) patch.corners[c] = vertex_of(told, c);
  surface_.connect_around(std::span(patch.corners).first(patch.count));
  patch.visible = true;
  const Mover& mover = movers_[patch.mover];
  if (!mover.deforms) ++seen_[mover.object];
  for (std::uint32_t c = 0; c < patch.count; ++c) ++shown_[patch.corners[c]];
}

std::uint32_t MoverScope::vertex_of(const MoverPatch& patch, std::uint32_t corner) {
  FlatIndex& known = positions_[patch.mover];
  const std::uint64_t key = key_of(patch.rest[corner]);
  const std::uint32_t found = known.find(key);
  if (found != FlatIndex::kNone) return found;
  const std::uint32_t vertex = surface_.add(patch.rest[corner]);
  known.insert(key, vertex);
  ids_.push_back(patch.vertices[corner]);
  shown_.push_back(0);
  return vertex;
}

std::span<const std::uint32_t> MoverScope::corners(PatchId patch) const {
  const std::uint32_t number = numbers_.find(value(patch));
  if (number == FlatIndex::kNone) return {};
  return std::span(patches_[number].corners).first(patches_[number].count);
}

}  // namespace atlaswire::codec
