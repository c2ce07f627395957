#pragma once

#include "base/grid.h"
#include "base/ids.h"
#include "base/result.h"
#include "codec/motion.h"
#include "codec/mover_scope.h"
#include "codec/mover_watch.h"
#include "proto/stream_description.h"

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace atlaswire::client {

/// Where what moves in a stream's scene is. A stream's motion message belongs to its update, and like it is
/// applied once, in order. Safe on hostile updates and messages.
class MovingReplica {
 public:
  /// `motion` as it came through the wire's checks; `seed` unknown to the peer.
  MovingReplica(const proto::MotionDescription& motion, const PositionGrid& grid, std::uint64_t seed);

  /// What an update says of movers. Every update that a decoder gives, in order, as soon as it is there.
  codec::MoverChange watch(const codec::MetaUpdate& update) { return watch_.take(update); }
  /// Moves everything to the frame of the update that `change` is of. After an error places are nonsense
  /// until a change with reset came.
  Result<void> move(const codec::MoverChange& change, ByteView message);

  /// Puts a patch's corners where they are now, relative to `origin`, if it moves. `rest`: grid positions by
  /// vertex; `corners` and `positions`: as many as the patch has.
  void place(PatchId patch, std::span<const GridPosition> rest, std::span<const VertexId> corners,
             const glm::dvec3& origin, std::span<glm::vec3> positions) const;

 private:
  /// x -> turn * x + shift, in scene coordinates.
  struct Placement {
    glm::dmat3 turn{1.0};
    glm::dvec3 shift{0.0};
  };

  proto::MotionDescription description_;
  PositionGrid grid_;
  codec::MoverWatch watch_;
  codec::MoverScope scope_;
  codec::MotionDecoder decoder_;
  std::vector<Placement> placements_;  ///< by object
};

}  // namespace atlaswire::client
