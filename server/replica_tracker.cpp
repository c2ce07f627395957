#include "server/replica_tracker.h"

#include "base/assert.h"
#include "render/scene/scene_motion.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace atlaswire::server {

PositionGrid scene_grid(const render::Scene& scene, std::uint32_t bits) {
  const glm::dvec3 low = scene.origin + glm::dvec3(scene.box.low);
  const glm::dvec3 high = scene.origin + glm::dvec3(scene.box.high);
  return PositionGrid::over(low, high, bits == 0 ? PositionGrid::suited_bits(low, high) : bits);
}

namespace {

/// Grid points that somebody has. One that is taken leads to the next along x, then y, then z, so that
/// however many rest at one point, each finds a free one fast.
class TakenPoints {
 public:
  explicit TakenPoints(std::uint32_t bits) : bits_(bits) {}

  /// False: somebody has it.
  bool take(const GridPosition& at) { return next_.emplace(index_of(at), after(index_of(at))).second; }
  /// The first free one from `at` on, taken.
  GridPosition take_next(const GridPosition& at) {
    std::uint64_t found = index_of(at);
    for (auto step = next_.find(found); step != next_.end(); step = next_.find(found)) {
      found = step->second;
      // The next who comes here goes two steps at once.
      if (const auto second = next_.find(found); second != next_.end()) step->second = second->second;
    }
    next_.emplace(found, after(found));
    const std::uint64_t mask = (std::uint64_t{1} << bits_) - 1;
    return {found & mask, found >> bits_ & mask, found >> 2 * bits_};
  }

 private:
  [[nodiscard]] std::uint64_t index_of(const GridPosition& p) const {
    return std::uint64_t{p.x} | std::uint64_t{p.y} << bits_ | std::uint64_t{p.z} << 2 * bits_;
  }
  [[nodiscard]] std::uint64_t after(std::uint64_t index) const {
    return (index + 1) & ((std::uint64_t{1} << 3 * bits_) - 1);
  }

  std::uint32_t bits_;
  std::unordered_map<std::uint64_t, std::uint64_t> next_;  ///< by index of a taken one
};

std::map<std::uint32_t, GridPosition> nudge_apart(const render::Scene& scene, const PositionGrid& grid) {
  std::map<std::uint32_t, GridPosition> nudged;
  if (!scene.motion) return nudged;
  for (const render::MovingPart& part : scene.motion->parts) {
    // More points than the grid has could not be told apart anyway.
    if (!part.mover.deforms || part.positions.count >= std::uint64_t{1} << 3 * grid.bits) continue;
    TakenPoints taken(grid.bits);
    std::vector<std::uint32_t> later;
    const auto place = [&](std::uint32_t p) {
      return grid.quantize(scene.origin + glm::dvec3(scene.positions[p]));
    };
    for (std::uint32_t p = part.positions.first; p < part.positions.end(); ++p) {
      if (!taken.take(place(p))) later.push_back(p);
    }
    for (const std::uint32_t p : later) nudged.emplace(p, taken.take_next(place(p)));
  }
  return nudged;
}

}  // namespace

ReplicaTracker::ReplicaTracker(std::shared_ptr<const render::Scene> scene, std::uint32_t grid_bits)
    : scene_(std::move(scene)),
      grid_(scene_grid(*scene_, grid_bits)),
      nudged_(nudge_apart(*scene_, grid_)),
      known_(scene_->positions.size()) {}

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
  for (const auto& placed : change.added) add(placed.patch, placed.block, update);
  update.moved.reserve(change.moved.size());
  for (const auto& placed : change.moved) update.moved.push_back({placed.patch, placed.block});
  add_vertices(update);
  return update;
}

codec::MetaUpdate ReplicaTracker::restart(FrameId frame, std::span<const render::PlacedPatch> blocks) {
  forget();
  codec::MetaUpdate update;
  update.frame = frame;
  update.reset = true;
  update.added.reserve(blocks.size());
  for (const auto& placed : blocks) add(placed.patch, placed.block, update);
  add_vertices(update);
  return update;
}

void ReplicaTracker::forget() {
  known_.assign(known_.size(), false);
  asked_.clear();
}

codec::MetaUpdate ReplicaTracker::update(FrameId frame, const Asked& asked) {
  codec::MetaUpdate update;
  update.frame = frame;
  compare(asked, update);
  add_vertices(update);
  if (asked.change->reset) {
    layout_.begin(asked.live);
  } else {
    layout_.follow(*asked.change);
  }
  update.cue = {.reset = asked.change->reset, .check = layout_.hash().upper()};
  return update;
}

codec::MetaUpdate ReplicaTracker::restart(FrameId frame, const Asked& asked) {
  AW_ASSERT(asked.change->reset);
  forget();
  codec::MetaUpdate all = update(frame, asked);
  all.reset = true;
  return all;
}

namespace {

Block wanted_block(const render::BlockRequest& request) {
  return {
      .width_log2 = request.width_log2, .height_log2 = request.height_log2, .transposed = request.transposed};
}

}  // namespace

/// Who asks that did not ask in the frame before, who asks no longer, and who asks for something else.
void ReplicaTracker::compare(const Asked& asked, codec::MetaUpdate& update) {
  auto before = asked_.begin();
  for (const render::BlockRequest& request : asked.requests) {
    for (; before != asked_.end() && before->patch < request.patch; ++before) {
      update.removed.push_back(before->patch);
    }
    const Block block = wanted_block(request);
    if (before == asked_.end() || before->patch != request.patch) {
      add(request.patch, block, update);
      continue;
    }
    if (wanted_block(*before) != block) update.moved.push_back({request.patch, block});
    ++before;
  }
  for (; before != asked_.end(); ++before) update.removed.push_back(before->patch);
  asked_.assign(asked.requests.begin(), asked.requests.end());
}

void ReplicaTracker::add(PatchId id, const Block& block, codec::MetaUpdate& update) {
  AW_ASSERT(value(id) < scene_->patches.size());
  const render::Patch& patch = scene_->patches[value(id)];
  codec::AddedPatch added;
  added.id = id;
  added.triangles = patch.triangles;
  added.draw = scene_->materials[patch.material].draw;
  added.block = block;
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
    const auto nudged = nudged_.find(vertex);
    update.vertices.push_back(
        {static_cast<VertexId>(vertex), nudged == nudged_.end() ? grid_.quantize(position) : nudged->second});
  }
  new_ones_.clear();
}

}  // namespace atlaswire::server
