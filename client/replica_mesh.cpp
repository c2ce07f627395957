#include "client/replica_mesh.h"

namespace atlaswire::client {

ReplicaMesher::ReplicaMesher(const PositionGrid& grid)
    : step_(grid.step),
      half_(static_cast<double>(1U << (grid.bits - 1))),
      origin_(grid.origin + glm::dvec3(half_ * step_)) {}

void ReplicaMesher::build(const Replica& replica, const MovingReplica* moving, render::MeshData& mesh) {
  const std::span<const GridPosition> grid_positions = replica.positions();
  patches_.clear();
  patches_.reserve(replica.patches().size());
  for (const ReplicaPatch& patch : replica.patches()) {
    render::DisplayPatch& out = patches_.emplace_back();
    out.triangles = patch.triangles;
    out.draw = patch.draw;
    out.block = patch.block;
    for (std::uint32_t i = 0; i < corner_count(patch.triangles); ++i) {
      const GridPosition& p = grid_positions[value(patch.corners[i])];
      out.positions[i] = glm::vec3((glm::dvec3(p) - half_) * step_);
    }
    if (moving == nullptr) continue;
    const std::size_t count = corner_count(patch.triangles);
    moving->place(patch.id, grid_positions, std::span(patch.corners).first(count), origin_,
                  std::span(out.positions).first(count));
  }
  render::build_mesh(patches_, mesh);
}

}  // namespace atlaswire::client
