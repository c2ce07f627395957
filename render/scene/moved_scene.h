#pragma once

#include "base/pose.h"
#include "render/scene/animator.h"
#include "render/scene/deformed_frames.h"
#include "render/scene/scene.h"
#include "render/scene/scene_motion.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace atlaswire::render {

/// Where what moves in a scene is at a time, on the host: everything that Scene has of it, moved. Starts at
/// rest. In a scene where nothing moves it stays so, at no cost. What a file sends beyond 1e9 m stays at
/// rest, or where it was. Deterministic.
class MovedScene {
 public:
  explicit MovedScene(std::shared_ptr<const Scene> scene);

  /// Moves everything to where it is so many seconds in; nullopt: to its rest.
  void pose(std::optional<double> seconds);

  [[nodiscard]] std::span<const MovingPart> parts() const { return parts_; }
  /// Changes whenever a pose moved the part; never twice the same, and 0 before the first.
  [[nodiscard]] std::uint64_t version(std::size_t part) const { return moved_[part].version; }
  [[nodiscard]] std::span<const ShadingVertex> vertices(std::size_t part) const {
    return moved_[part].vertices;
  }
  [[nodiscard]] std::span<const glm::vec3> positions(std::size_t part) const {
    return moved_[part].positions;
  }
  /// Of every chunk, whether it moves or not.
  [[nodiscard]] std::span<const Box> boxes() const { return boxes_; }
  /// How a rigid object has moved from its rest, about its pivot: Animator::rigid_motion.
  [[nodiscard]] const Pose& motion(std::size_t object) const { return objects_[object].motion; }
  [[nodiscard]] const glm::dvec3& pivot(std::size_t object) const { return objects_[object].pivot; }
  /// Where a vertex of the scene is.
  [[nodiscard]] const ShadingVertex& vertex(std::uint32_t number) const;
  /// Which part a chunk is of; nullopt: it rests.
  [[nodiscard]] std::optional<std::size_t> part_of_chunk(std::uint32_t chunk) const;

 private:
  struct Moved {
    std::vector<ShadingVertex> vertices;
    std::vector<glm::vec3> positions;
    std::optional<DeformedFrames> frames;  ///< of one that deforms
    std::uint64_t version = 0;
  };
  struct Object {
    Pose motion;
    glm::dvec3 pivot{0.0};
    bool moved = false;  ///< in the last pose
  };

  void rest(std::size_t part);
  void pose_objects();
  void move_rigid(std::size_t part);
  void deform(std::size_t part);
  void note_moved(std::size_t part);

  std::shared_ptr<const Scene> scene_;
  std::span<const MovingPart> parts_;
  std::optional<Animator> animator_;
  std::vector<Moved> moved_;  ///< by part
  std::vector<Object> objects_;
  std::vector<Box> boxes_;
  bool at_rest_ = true;
  std::uint64_t versions_ = 0;
  std::vector<glm::dvec3> posed_;
};

/// Grows the boxes of a moving scene, and of what moves in it, over all places where it is at times spread
/// over its longest clip. Between those it may be a little outside.
void sweep(Scene& scene);

}  // namespace atlaswire::render
