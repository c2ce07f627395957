#include "server/replica_tracker.h"

#include "base/assert.h"

#include <algorithm>

namespace atlaswire::server {

PositionGrid scene_grid(const render::Scene& scene, std::uint32_t bits) {
  const glm::dvec3 low = scene.origin + glm::dvec3(scene.box.low);
  const glm::dvec3 high = scene.origin + glm::dvec3(scene.box.high);
  return PositionGrid::over(low, high, bits == 0 ? PositionGrid::suited_bits(low, high) : bits);
}

ReplicaTracker::ReplicaTracker(std::shared_ptr<const render::Scene> scene, std::uint32_t grid_bits)
    : scene_(std::move(scene)), grid_(scene_grid(*scene_, grid_bits)), known_(scene_->positions.size()) {}

codec::MetaLimits ReplicaTracker::limits(const Extent2D& atlas) const {
  codec::MetaLimits limits;
  limits.max_vertices = std::max(1U, static_cast<std::uint32_t>(scene_->positions.size()));
  limits.max_patches = std::max(1U, static_cast<std::uint32_t>(scene_->patches.size()));
  limits.grid_bits = grid_.bits;
  limits.atlas = atlas;
  return limits;
}

codec::MetaUpdate ReplicaTracker::update(FrameId frame, const render::LayoutChange& change) {
  codec::MetaUpdate update;
  update.frame = frame;
  update.removed = change.removed;
  update.added.reserve(change.added.size());
  for (const auto& placed : change.added) add(placed, update);
  update.moved.reserve(change.moved.size());
  for (const auto& placed : change.moved) update.moved.push_back({placed.patch, placed.block});
  add_vertices(update);
  return update;
}

codec::MetaUpdate ReplicaTracker::restart(FrameId frame, std::span<const render::PlacedPatch> blocks) {
  known_.assign(known_.size(), false);
  codec::MetaUpdate update;
  update.frame = frame;
  update.reset = true;
  update.added.reserve(blocks.size());
  for (const auto& placed : blocks) add(placed, update);
  add_vertices(update);
  return update;
}

void ReplicaTracker::add(const render::PlacedPatch& placed, codec::MetaUpdate& update) {
  AW_ASSERT(value(placed.patch) < scene_->patches.size());
  const render::Patch& patch = scene_->patches[value(placed.patch)];
  codec::AddedPatch added;
  added.id = placed.patch;
  added.triangles = patch.triangles;
  added.draw = scene_->materials[patch.material].draw;
  added.block = placed.block;
  for (std::uint32_t corner = 0; corner < corner_count(patch.triangles); ++corner) {
    const VertexId vertex = patch.positions[corner];
    added.corners[corner] = vertex;
    if (known_[value(vertex)]) continue;
    known_[value(vertex)] = true;
    new_ones_.push_back(value(vertex));
  }
  update.added.push_back(added);
}

void ReplicaTracker::add_vertices(codec::MetaUpdate& update) {
  std::sort(new_ones_.begin(), new_ones_.end());
  update.vertices.reserve(new_ones_.size());
  for (const std::uint32_t vertex : new_ones_) {
    const glm::dvec3 position = scene_->origin + glm::dvec3(scene_->positions[vertex]);
    update.vertices.push_back({static_cast<VertexId>(vertex), grid_.quantize(position)});
  }
  new_ones_.clear();
}

}  // namespace atlaswire::server
