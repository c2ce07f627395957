#pragma once

#include "base/grid.h"
#include "client/moving_replica.h"
#include "client/replica.h"
#include "render/display/mesh_builder.h"

#include <glm/vec3.hpp>
#include <vector>

namespace atlaswire::client {

/// Makes the vertex buffer of [SAS] 3.6 from a replica: positions off the grid, texture coordinates from
/// the blocks, no lookups left for the display. Keeps its memory from mesh to mesh.
class ReplicaMesher {
 public:
  explicit ReplicaMesher(const PositionGrid& grid);

  /// What positions are relative to: the grid's centre, so that floats hold every grid point exactly.
  [[nodiscard]] const glm::dvec3& origin() const { return origin_; }
  /// `moving`: where what moves is; null: nothing does.
  void build(const Replica& replica, const MovingReplica* moving, render::MeshData& mesh);

 private:
  double step_;
  double half_;  ///< grid units from the grid's corner to its centre
  glm::dvec3 origin_;
  std::vector<render::DisplayPatch> patches_;
};

}  // namespace atlaswire::client
