#include "client/moving_replica.h"

#include <glm/gtc/quaternion.hpp>

namespace atlaswire::client {

MovingReplica::MovingReplica(const proto::MotionDescription& motion, const PositionGrid& grid,
                             std::uint64_t seed)
    : description_(motion),
      grid_(grid),
      watch_(motion.movers),
      scope_(motion.movers, seed),
      decoder_({grid, {.step = motion.translation_step, .rotation_bits = motion.rotation_bits}}),
      placements_(motion.pivots.size()) {}

Result<void> MovingReplica::move(const codec::MoverChange& change, ByteView message) {
  scope_.follow(change);
  const codec::MotionScope scope = scope_.scope();
  if (auto decoded = decoder_.decode(scope, message); !decoded) return decoded;
  for (const std::uint32_t object : scope.objects) {
    const codec::RigidTransform now = decoder_.transform(object);
    const glm::dvec3 pivot = grid_.position(description_.pivots[object]);
    Placement& placement = placements_[object];
    placement.turn = glm::mat3_cast(now.orientation);
    placement.shift = pivot + now.translation - placement.turn * pivot;
  }
  return {};
}

void MovingReplica::place(PatchId patch, std::span<const GridPosition> rest,
                          std::span<const VertexId> corners, const glm::dvec3& origin,
                          std::span<glm::vec3> positions) const {
  const Mover* mover = codec::find_mover(description_.movers, patch);
  if (mover == nullptr) return;
  if (!mover->deforms) {
    const Placement& placement = placements_[mover->object];
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const glm::dvec3 at = grid_.position(rest[value(corners[c])]);
      positions[c] = glm::vec3(placement.turn * at + placement.shift - origin);
    }
    return;
  }
  const std::span<const std::uint32_t> vertices = scope_.corners(patch);
  for (std::size_t c = 0; c < vertices.size() && c < positions.size(); ++c)
    positions[c] = glm::vec3(decoder_.position(scope_.surface(), vertices[c]) - origin);
}

}  // namespace atlaswire::client
