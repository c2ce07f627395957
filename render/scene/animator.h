#pragma once

#include "base/pose.h"
#include "render/scene/source.h"

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <optional>
#include <span>
#include <vector>

namespace atlaswire::render {

/// Plays a scene's clips on the host: where its nodes, rigid instances and deformed vertices are at a time.
/// All clips play at once, each over and over; where two move one property, the later counts. A position that
/// is not finite, which a file's numbers can lead to, comes out as the rest position. Deterministic.
class Animator {
 public:
  /// Borrows the source, whose rig moves.
  explicit Animator(const SceneSource& source);

  /// Moves every node to where it is so many seconds in; from negative times on too.
  void pose(double seconds);

  /// A node's space to the scene's, now.
  [[nodiscard]] const glm::dmat4& node(std::uint32_t number) const { return to_scene_[number]; }
  /// Whether a skin or morph targets deform an instance.
  [[nodiscard]] bool deforms(std::uint32_t instance) const;
  /// Where an instance's node has its origin at rest: what rigid motions turn about.
  [[nodiscard]] glm::dvec3 pivot(std::uint32_t instance) const;
  /// How an instance that nothing deforms has moved from its rest: scene = orientation * (rest - pivot) +
  /// pivot + position. nullopt: it is deformed, or what moved it there is more than a rotation and a
  /// translation.
  [[nodiscard]] std::optional<Pose> rigid_motion(std::uint32_t instance) const;
  /// Where an instance's vertices are in the scene, metres: one for each of its mesh's. Morphing comes before
  /// skinning; a skinned instance ignores its own node (glTF 2.0, 3.7.3.1).
  void positions(std::uint32_t instance, std::vector<glm::dvec3>& out) const;

 private:
  void move(double seconds);
  void place();
  [[nodiscard]] std::vector<glm::dmat4> joint_matrices(const RigSkin& skin) const;

  const SceneSource* source_;
  const Rig* rig_;
  std::vector<RigNode> nodes_;  ///< as they are now
  std::vector<glm::dmat4> to_scene_;
  std::vector<glm::dmat4> rest_to_scene_;
};

}  // namespace atlaswire::render
