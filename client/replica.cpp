#include "client/replica.h"

#include "base/assert.h"

#include <algorithm>
#include <limits>

namespace atlaswire::client {
namespace {

constexpr std::uint32_t kLastEpoch = std::numeric_limits<std::uint32_t>::max() / 2 - 1;

template <class T>
void grow_to(std::vector<T>& v, std::uint32_t index) {
  if (index >= v.size()) v.resize(std::max<std::size_t>(std::size_t{index} + 1, v.size() * 3 / 2));
}

}  // namespace

bool Replica::is_live(PatchId id) const { return value(id) < slot_.size() && slot_[value(id)] != 0; }

bool Replica::is_known(VertexId id) const { return value(id) < known_.size() && known_[value(id)] != 0; }

bool Replica::is_marked(PatchId id, Mark m) const {
  return value(id) < patch_stamp_.size() &&
         patch_stamp_[value(id)] == epoch_ * 2 + static_cast<std::uint32_t>(m);
}

void Replica::mark(PatchId id, Mark m) {
  grow_to(patch_stamp_, value(id));
  patch_stamp_[value(id)] = epoch_ * 2 + static_cast<std::uint32_t>(m);
}

void Replica::begin_marks() {
  if (epoch_ == kLastEpoch) {
    std::ranges::fill(patch_stamp_, 0U);
    std::ranges::fill(vertex_stamp_, 0U);
    epoch_ = 0;
  }
  ++epoch_;
}

bool Replica::block_fits(const Block& b) const {
  if (b.width_log2 > 15 || b.height_log2 > b.width_log2) return false;
  return b.x + b.width() <= limits_.atlas.width && b.y + b.height() <= limits_.atlas.height;
}

Result<void> Replica::check_added(const codec::AddedPatch& patch, bool reset) {
  if (value(patch.id) >= limits_.max_patches) return ReplicaError::kPatchOutOfRange;
  if (is_marked(patch.id, Mark::kAdded)) return ReplicaError::kPatchKnown;
  if (!reset && is_live(patch.id) && !is_marked(patch.id, Mark::kRemoved)) return ReplicaError::kPatchKnown;
  if (patch.triangles < 1 || patch.triangles > kMaxPatchTriangles) return ReplicaError::kBadTriangleCount;
  for (std::uint32_t i = 0; i < corner_count(patch.triangles); ++i) {
    const VertexId corner = patch.corners[i];
    const bool sent_now = value(corner) < vertex_stamp_.size() && vertex_stamp_[value(corner)] == epoch_;
    if (!sent_now && (reset || !is_known(corner))) return ReplicaError::kVertexUnknown;
  }
  if (!block_fits(patch.block)) return ReplicaError::kBadBlock;
  mark(patch.id, Mark::kAdded);
  return {};
}

Result<void> Replica::check(const codec::MetaUpdate& update) {
  begin_marks();
  if (update.reset && !update.removed.empty()) return ReplicaError::kRemovalAfterReset;
  for (const PatchId id : update.removed) {
    if (!is_live(id) || is_marked(id, Mark::kRemoved)) return ReplicaError::kPatchUnknown;
    mark(id, Mark::kRemoved);
  }
  const std::uint32_t side = 1U << std::min(limits_.grid_bits, 31U);
  for (const codec::NewVertex& vertex : update.vertices) {
    if (value(vertex.id) >= limits_.max_vertices) return ReplicaError::kVertexOutOfRange;
    grow_to(vertex_stamp_, value(vertex.id));
    std::uint32_t& stamp = vertex_stamp_[value(vertex.id)];
    if (stamp == epoch_ || (!update.reset && is_known(vertex.id))) return ReplicaError::kVertexKnown;
    stamp = epoch_;
    const GridPosition& p = vertex.position;
    if (p.x >= side || p.y >= side || p.z >= side) return ReplicaError::kBadPosition;
  }
  for (const codec::AddedPatch& patch : update.added) {
    if (Result<void> r = check_added(patch, update.reset); !r) return r;
  }
  for (const codec::MovedPatch& patch : update.moved) {
    const bool live = is_marked(patch.id, Mark::kAdded) ||
                      (!update.reset && is_live(patch.id) && !is_marked(patch.id, Mark::kRemoved));
    if (!live) return ReplicaError::kPatchUnknown;
    if (!block_fits(patch.block)) return ReplicaError::kBadBlock;
  }
  return {};
}

void Replica::remove(PatchId id) {
  const std::uint32_t slot = slot_[value(id)];
  AW_ASSERT(slot != 0);
  triangle_count_ -= patches_[slot - 1].triangles;
  patches_[slot - 1] = patches_.back();
  slot_[value(patches_.back().id)] = slot;
  patches_.pop_back();
  slot_[value(id)] = 0;
}

void Replica::forget_all() {
  for (const ReplicaPatch& patch : patches_) slot_[value(patch.id)] = 0;
  patches_.clear();
  std::ranges::fill(known_, std::uint8_t{0});
  vertex_count_ = 0;
  triangle_count_ = 0;
}

Result<void> Replica::apply(const codec::MetaUpdate& update) {
  if (Result<void> r = check(update); !r) return r;
  if (update.reset) forget_all();
  for (const PatchId id : update.removed) remove(id);
  for (const codec::NewVertex& vertex : update.vertices) {
    grow_to(positions_, value(vertex.id));
    grow_to(known_, value(vertex.id));
    positions_[value(vertex.id)] = vertex.position;
    known_[value(vertex.id)] = 1;
  }
  vertex_count_ += update.vertices.size();
  for (const codec::AddedPatch& patch : update.added) {
    grow_to(slot_, value(patch.id));
    patches_.push_back({.id = patch.id,
                        .triangles = patch.triangles,
                        .draw = patch.draw,
                        .corners = patch.corners,
                        .block = patch.block});
    slot_[value(patch.id)] = static_cast<std::uint32_t>(patches_.size());
    triangle_count_ += patch.triangles;
  }
  for (const codec::MovedPatch& patch : update.moved) {
    patches_[slot_[value(patch.id)] - 1].block = patch.block;
  }
  return {};
}

const char* error_text(ReplicaError e) {
  switch (e) {
    case ReplicaError::kPatchUnknown:
      return "the update names a patch that the client does not hold";
    case ReplicaError::kPatchKnown:
      return "the update adds a patch that the client holds already";
    case ReplicaError::kPatchOutOfRange:
      return "a patch id exceeds the agreed maximum";
    case ReplicaError::kVertexUnknown:
      return "a patch uses a vertex that was never sent";
    case ReplicaError::kVertexKnown:
      return "the update sends a vertex that the client holds already";
    case ReplicaError::kVertexOutOfRange:
      return "a vertex id exceeds the agreed maximum";
    case ReplicaError::kBadPosition:
      return "a vertex lies outside the position grid";
    case ReplicaError::kBadBlock:
      return "a block lies outside the atlas or is not landscape";
    case ReplicaError::kBadTriangleCount:
      return "a patch has 1 to 3 triangles";
    case ReplicaError::kRemovalAfterReset:
      return "an update that resets cannot remove patches";
  }
  return "unknown replica error";
}

}  // namespace atlaswire::client
