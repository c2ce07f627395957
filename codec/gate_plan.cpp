#include "codec/gate_plan.h"

#include "base/assert.h"

#include <algorithm>

namespace atlaswire::codec {

namespace {

/// Hidden patches that may be known besides four for each visible one.
constexpr std::uint32_t kSpareHidden = 1U << 16U;

bool has_shape(const GateState& state, const PatchShape& shape, const WantedPatch& patch) {
  if (shape.triangles != patch.triangles || shape.draw != patch.draw) return false;
  for (std::uint32_t i = 0; i < corner_count(shape.triangles); ++i) {
    if (state.vertices.position(shape.corners[i]) != patch.positions[i]) return false;
  }
  return true;
}

bool holds(const ResidentSet& residents, std::uint32_t index, PatchId id) {
  return index < residents.size() && residents.id(index) == id;
}

}  // namespace

void GatePlan::begin(const MetaUpdate& update, const GateState& state) {
  update_ = &update;
  for (const NewVertex& vertex : update.vertices) {
    const std::uint32_t id = value(vertex.id);
    if (id >= positions_.size()) positions_.resize(std::size_t{id} + 1);
    positions_[id] = vertex.position;
  }
  drops_.clear();
  returns_.clear();
  arrivals_.clear();
  const ResidentSet& residents = state.residents;
  drop_hidden(residents);
  for (const AddedPatch& patch : update.added) {
    const WantedPatch want = wanted(patch);
    const std::uint32_t at = residents.lower_bound(patch.id);
    const bool known = holds(residents, at, patch.id);
    if (known && has_shape(state, residents.shape(at), want)) {
      returns_.push_back(&patch);
      if (!drops_.empty()) drops_[at] = false;
      continue;
    }
    arrivals_.push_back(want);
    if (!known) continue;
    drops_.resize(residents.size());
    drops_[at] = true;
  }
  std::ranges::sort(arrivals_, {}, &WantedPatch::id);
}

WantedPatch GatePlan::wanted(const AddedPatch& patch) const {
  AW_ASSERT(patch.triangles >= 1 && patch.triangles <= kMaxPatchTriangles);
  WantedPatch want{.id = patch.id, .triangles = patch.triangles, .draw = patch.draw, .block = patch.block};
  for (std::uint32_t i = 0; i < corner_count(patch.triangles); ++i) {
    AW_ASSERT(value(patch.corners[i]) < positions_.size());
    want.positions[i] = positions_[value(patch.corners[i])];
  }
  return want;
}

void GatePlan::drop_hidden(const ResidentSet& residents) {
  const std::uint32_t visible = residents.visible();
  if (residents.size() - visible <= kSpareHidden + 4 * visible) return;
  drops_.resize(residents.size());
  for (std::uint32_t i = 0; i < residents.size(); ++i) drops_[i] = !residents.visible(i);
}

std::span<const Block* const> GatePlan::targets(const ResidentSet& left) {
  targets_.resize(left.size());
  for (std::uint32_t i = 0; i < left.size(); ++i) {
    targets_[i] = left.visible(i) ? &left.block(i) : nullptr;
  }
  for (const PatchId id : update_->removed) {
    const std::uint32_t at = left.lower_bound(id);
    // It is gone already if it comes back in another shape.
    if (holds(left, at, id)) targets_[at] = nullptr;
  }
  for (const AddedPatch* patch : returns_) targets_[left.lower_bound(patch->id)] = &patch->block;
  for (const MovedPatch& patch : update_->moved) {
    const std::uint32_t at = left.lower_bound(patch.id);
    AW_ASSERT(holds(left, at, patch.id) && targets_[at] != nullptr);
    targets_[at] = &patch.block;
  }
  return targets_;
}

}  // namespace atlaswire::codec
