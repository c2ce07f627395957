#pragma once

#include <array>
#include <cstdint>
#include <glm/ext/quaternion_double.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

namespace atlaswire::render {

/// A node of a hierarchy: where it is relative to its parent, unless a clip says otherwise.
struct RigNode {
  std::int32_t parent = -1;  ///< -1: the scene
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< unit
  glm::dvec3 scale{1.0};
  std::optional<glm::dmat4> matrix;  ///< instead of the three
  std::vector<double> weights;       ///< of its mesh's morph targets
};

/// How one property of a node goes through time (glTF 2.0, "Animations").
struct RigChannel {
  enum class Path : std::uint8_t { kTranslation, kRotation, kScale, kWeights };
  enum class Interpolation : std::uint8_t { kLinear, kStep, kCubicSpline };

  std::uint32_t node = 0;
  Path path = Path::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  std::uint32_t width =
      3;  ///< numbers a value: 3, of a rotation 4 (x, y, z, w), of weights as many as there are
  std::vector<float> times;   ///< seconds, ascending strictly, at least one
  std::vector<float> values;  ///< `width` a time; of a cubic spline in-tangent, value and out-tangent each
};

/// Channels that belong together.
struct RigClip {
  std::string name;
  std::vector<RigChannel> channels;
  double duration = 0;  ///< seconds; of its last key
};

/// Joints that deform a mesh together.
struct RigSkin {
  std::vector<std::uint32_t> joints;     ///< nodes
  std::vector<glm::dmat4> inverse_bind;  ///< one a joint: from the mesh's space to the joint's
};

/// What deforms a mesh's vertices; all lists are by SourceVertex::rig, empty where there is none of it.
struct RigMesh {
  std::vector<std::array<std::uint16_t, 4>> joints;  ///< into a skin's
  std::vector<std::array<float, 4>> weights;         ///< of the joints; not negative
  std::vector<std::vector<glm::vec3>> morphs;        ///< displacement at weight 1, by target
};

/// What places an instance.
struct RigInstance {
  std::uint32_t node = 0;
  std::int32_t skin = -1;  ///< -1: none
};

/// Everything in a scene that can move. Without clips nothing does. Who makes one sees to it that every
/// number of a node, joint or skin is in range, `order` is whole, and lists have the lengths that they
/// should.
struct Rig {
  std::vector<RigNode> nodes;
  std::vector<std::uint32_t> order;  ///< all nodes, parents before children
  std::vector<RigClip> clips;
  std::vector<RigSkin> skins;
  std::vector<RigMesh> meshes;         ///< by SceneSource::meshes
  std::vector<RigInstance> instances;  ///< by SceneSource::instances

  [[nodiscard]] bool moves() const { return !clips.empty(); }
};

}  // namespace atlaswire::render
