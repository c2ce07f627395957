#include "render/scene/animator.h"

#include "base/assert.h"
#include "render/scene/keyframes.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

namespace atlaswire::render {

namespace {

bool is_finite(const glm::dvec3& v) { return std::isfinite(v.x + v.y + v.z); }

glm::dmat4 local(const RigNode& node) {
  if (node.matrix) return *node.matrix;
  glm::dmat4 m = glm::translate(glm::dmat4(1.0), node.translation) * glm::mat4_cast(node.rotation);
  return glm::scale(m, node.scale);
}

/// Seconds into a clip that plays over and over.
double wrapped(double seconds, double duration) {
  if (!(duration > 0)) return 0;
  const double rest = std::fmod(seconds, duration);
  return rest < 0 ? rest + duration : rest;
}

void apply(const RigChannel& channel, std::span<const double> value, RigNode& node) {
  switch (channel.path) {
    case RigChannel::Path::kTranslation:
      node.translation = glm::make_vec3(value.data());
      return;
    case RigChannel::Path::kRotation:
      node.rotation = glm::dquat(value[3], value[0], value[1], value[2]);
      return;
    case RigChannel::Path::kScale:
      node.scale = glm::make_vec3(value.data());
      return;
    case RigChannel::Path::kWeights:
      node.weights.assign(value.begin(), value.end());
      return;
  }
}

}  // namespace

Animator::Animator(const SceneSource& source)
    : source_(&source), rig_(&source.rig), nodes_(rig_->nodes), to_scene_(nodes_.size()) {
  AW_ASSERT(rig_->moves() && rig_->instances.size() == source.instances.size());
  place();
  rest_to_scene_ = to_scene_;
}

void Animator::pose(double seconds) {
  move(seconds);
  place();
}

void Animator::move(double seconds) {
  std::vector<double> value;
  for (const RigClip& clip : rig_->clips) {
    const double into = wrapped(seconds, clip.duration);
    for (const RigChannel& channel : clip.channels) {
      value.resize(channel.width);
      sample(channel, into, value);
      apply(channel, value, nodes_[channel.node]);
    }
  }
}

void Animator::place() {
  for (const std::uint32_t n : rig_->order) {
    const std::int32_t parent = nodes_[n].parent;
    to_scene_[n] =
        parent < 0 ? local(nodes_[n]) : to_scene_[static_cast<std::size_t>(parent)] * local(nodes_[n]);
  }
}

bool Animator::deforms(std::uint32_t instance) const {
  const std::uint32_t mesh = source_->instances[instance].mesh;
  return rig_->instances[instance].skin >= 0 || !rig_->meshes[mesh].morphs.empty();
}

glm::dvec3 Animator::pivot(std::uint32_t instance) const {
  return glm::dvec3(rest_to_scene_[rig_->instances[instance].node][3]);
}

std::optional<Pose> Animator::rigid_motion(std::uint32_t instance) const {
  if (deforms(instance)) return std::nullopt;
  const std::uint32_t n = rig_->instances[instance].node;
  Pose motion;
  if (to_scene_[n] == rest_to_scene_[n]) return motion;
  const glm::dmat4 moved = to_scene_[n] * glm::inverse(rest_to_scene_[n]);
  motion.position = glm::dvec3(to_scene_[n][3] - rest_to_scene_[n][3]);
  const glm::dmat3 turned(moved);
  motion.orientation = glm::normalize(glm::quat_cast(turned));
  const glm::dmat3 left = turned - glm::mat3_cast(motion.orientation);
  constexpr double kTolerance = 1e-5;
  for (int column = 0; column < 3; ++column) {
    // A NaN is no rotation either.
    if (!(glm::dot(left[column], left[column]) < kTolerance * kTolerance)) return std::nullopt;
  }
  if (!is_finite(motion.position)) return std::nullopt;
  return motion;
}

std::vector<glm::dmat4> Animator::joint_matrices(const RigSkin& skin) const {
  std::vector<glm::dmat4> out;
  out.reserve(skin.joints.size());
  for (std::size_t i = 0; i < skin.joints.size(); ++i)
    out.push_back(to_scene_[skin.joints[i]] * skin.inverse_bind[i]);
  return out;
}

void Animator::positions(std::uint32_t instance, std::vector<glm::dvec3>& out) const {
  const SourceInstance& placed = source_->instances[instance];
  const SourceMesh& mesh = source_->meshes[placed.mesh];
  const RigMesh& rig = rig_->meshes[placed.mesh];
  const RigInstance& by = rig_->instances[instance];
  const std::vector<double>& weights = nodes_[by.node].weights;
  const std::size_t morphs = std::min(weights.size(), rig.morphs.size());
  const bool skinned = by.skin >= 0 && !rig.joints.empty();
  std::vector<glm::dmat4> joints;
  if (skinned) joints = joint_matrices(rig_->skins[static_cast<std::size_t>(by.skin)]);
  out.resize(mesh.vertices.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const SourceVertex& vertex = mesh.vertices[i];
    glm::dvec3 from(vertex.position);
    for (std::size_t m = 0; m < morphs; ++m) from += weights[m] * glm::dvec3(rig.morphs[m][vertex.rig]);
    glm::dvec3 to(to_scene_[by.node] * glm::dvec4(from, 1.0));
    if (skinned) {
      glm::dvec3 sum(0.0);
      double total = 0;
      for (std::size_t j = 0; j < 4; ++j) {
        const double weight = rig.weights[vertex.rig][j];
        if (weight == 0) continue;
        total += weight;
        sum += weight * glm::dvec3(joints[rig.joints[vertex.rig][j]] * glm::dvec4(from, 1.0));
      }
      if (total > 0) to = sum / total;
    }
    out[i] = is_finite(to) ? to : glm::dvec3(placed.to_scene * glm::dvec4(glm::dvec3(vertex.position), 1.0));
  }
}

}  // namespace atlaswire::render
