#include "server/replica_tracker.h"

#include "base/assert.h"
#include "render/scene/scene_motion.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <unordered_set>
#include <utility>

namespace atlaswire::server {

PositionGrid scene_grid(const render::Scene& scene, std::uint32_t bits) {
  const glm::dvec3 low = scene.origin + glm::dvec3(scene.box.low);
  const glm::dvec3 high = scene.origin + glm::dvec3(scene.box.high);
  return PositionGrid::over(low, high, bits == 0 ? PositionGrid::suited_bits(low, high) : bits);
}

namespace {

std::uint64_t key_of(const GridPosition& p) {
  return std::uint64_t{p.x} | std::uint64_t{p.y} << 20U | std::uint64_t{p.z} << 40U;
}

/// The nearest grid point that is not in `taken`, in shells of growing cubes.
GridPosition nearest_free(const GridPosition& at, const std::unordered_set<std::uint64_t>& taken,
                          std::uint32_t bits) {
  const std::int64_t side = std::int64_t{1} << bits;
  for (std::int64_t reach = 1; reach < side; ++reach) {
    for (std::int64_t z = -reach; z <= reach; ++z) {
      for (std::int64_t y = -reach; y <= reach; ++y) {
        const bool inner = std::abs(z) < reach && std::abs(y) < reach;
        for (std::int64_t x = -reach; x <= reach; x += inner ? 2 * reach : 1) {
          const std::array<std::int64_t, 3> p{at.x + x, at.y + y, at.z + z};
          if (std::ranges::any_of(p, [side](std::int64_t c) { return c < 0 || c >= side; })) continue;
          const GridPosition found{p[0], p[1], p[2]};
          if (!taken.contains(key_of(found))) return found;
        }
      }
    }
  }
  return at;
}

std::map<std::uint32_t, GridPosition> nudge_apart(const render::Scene& scene, const PositionGrid& grid) {
  std::map<std::uint32_t, GridPosition> nudged;
  if (!scene.motion) return nudged;
  std::unordered_set<std::uint64_t> taken;
  for (const render::MovingPart& part : scene.motion->parts) {
    if (!part.mover.deforms) continue;
    taken.clear();
    std::vector<std::uint32_t> later;
    const auto place = [&](std::uint32_t p) {
      return grid.quantize(scene.origin + glm::dvec3(scene.positions[p]));
    };
    for (std::uint32_t p = part.positions.first; p < part.positions.end(); ++p) {
      if (!taken.insert(key_of(place(p))).second) later.push_back(p);
    }
    for (const std::uint32_t p : later) {
      const GridPosition found = nearest_free(place(p), taken, grid.bits);
      taken.insert(key_of(found));
      nudged.emplace(p, found);
    }
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
