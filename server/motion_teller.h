#pragma once

#include "base/grid.h"
#include "codec/motion.h"
#include "codec/mover_scope.h"
#include "codec/mover_watch.h"
#include "proto/stream_description.h"
#include "render/scene/moved_scene.h"
#include "render/scene/scene.h"

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

namespace atlaswire::server {

/// Where what moves was in one frame.
struct MovedFrame {
  std::vector<glm::vec3> points;                  ///< of all parts that deform, one after another
  std::vector<codec::RigidTransform> transforms;  ///< by object, about its pivot on the grid
};

/// What clients must know beforehand of what moves in a scene; it must have motion.
proto::MotionDescription describe_motion(const render::Scene& scene, const PositionGrid& grid);

/// Tells clients of a stream where what moves is: behind each meta update a motion message. The scene must
/// have motion.
class MotionTeller {
 public:
  MotionTeller(std::shared_ptr<const render::Scene> scene, const PositionGrid& grid);

  [[nodiscard]] const proto::MotionDescription& description() const { return description_; }
  /// Any thread.
  [[nodiscard]] MovedFrame look(const render::MovedScene& moved) const;
  /// Appends the message behind `update`, of which `moved` is the frame. Every update of a stream whose
  /// clients show motion, in order. One thread. What has left the grid's margins is told at their edge.
  /// Errors: codec::MotionError, of an object that flew away.
  Result<void> tell(const codec::MetaUpdate& update, const MovedFrame& moved, ByteBuffer& out);
  /// What the last message told, in its scope's order; valid until the next.
  [[nodiscard]] codec::MotionTargets told() const { return {false, positions_, transforms_}; }

 private:
  [[nodiscard]] glm::dvec3 place_of(VertexId id, const MovedFrame& moved) const;

  /// Where a part's points begin.
  struct Run {
    std::uint32_t first = 0;  ///< of Scene::positions
    std::uint32_t at = 0;     ///< into MovedFrame::points
  };
  std::shared_ptr<const render::Scene> scene_;
  PositionGrid grid_;
  proto::MotionDescription description_;
  std::vector<Run> runs_;  ///< ascending
  codec::MoverWatch watch_;
  codec::MoverScope scope_;
  codec::MotionEncoder encoder_;
  std::vector<glm::dvec3> positions_;
  std::vector<codec::RigidTransform> transforms_;
};

}  // namespace atlaswire::server
