#include "render/scene/find_movers.h"

#include "base/log.h"
#include "base/mover.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numeric>

namespace atlaswire::render {

namespace {

/// What clips do to a node, by itself.
struct NodeMotion {
  bool moves = false;
  bool turns = false;
  bool scales = false;
};

/// Exporters write tracks of constant scale for every joint.
bool keeps_scale(const RigChannel& channel, const glm::dvec3& rest) {
  constexpr double kTolerance = 1e-6;
  if (channel.interpolation == RigChannel::Interpolation::kCubicSpline) return false;
  for (std::size_t i = 0; i < channel.values.size(); ++i) {
    if (!(std::abs(double{channel.values[i]} - rest[static_cast<int>(i % 3)]) <= kTolerance)) return false;
  }
  return true;
}

std::vector<NodeMotion> motions_of(const Rig& rig) {
  std::vector<NodeMotion> motions(rig.nodes.size());
  for (const RigClip& clip : rig.clips) {
    for (const RigChannel& channel : clip.channels) {
      NodeMotion& motion = motions[channel.node];
      const RigNode& node = rig.nodes[channel.node];
      if (channel.path == RigChannel::Path::kWeights || node.matrix) continue;
      const bool scales = channel.path == RigChannel::Path::kScale;
      if (scales && keeps_scale(channel, node.scale)) continue;
      motion.moves = true;
      motion.turns |= channel.path == RigChannel::Path::kRotation;
      motion.scales |= scales;
    }
  }
  return motions;
}

/// Does a node's own transform keep the shape of what it places?
bool is_even(const RigNode& node) {
  constexpr double kTolerance = 1e-5;
  glm::dvec3 squares;
  if (node.matrix) {
    const glm::dmat3 m(*node.matrix);
    squares = {glm::dot(m[0], m[0]), glm::dot(m[1], m[1]), glm::dot(m[2], m[2])};
    const double skew = std::max(
        {std::abs(glm::dot(m[0], m[1])), std::abs(glm::dot(m[1], m[2])), std::abs(glm::dot(m[0], m[2]))});
    if (!(skew <= kTolerance * squares.x)) return false;
  } else {
    squares = node.scale * node.scale;
  }
  const double largest = std::max({squares.x, squares.y, squares.z});
  const double smallest = std::min({squares.x, squares.y, squares.z});
  return largest - smallest <= kTolerance * largest;
}

/// How each node moves, with all above it.
std::vector<InstanceMotion> ways_of(const Rig& rig) {
  const std::vector<NodeMotion> motions = motions_of(rig);
  std::vector<InstanceMotion> ways(rig.nodes.size(), InstanceMotion::kRests);
  std::vector<bool> even(rig.nodes.size(), true);
  for (const std::uint32_t n : rig.order) {
    const RigNode& node = rig.nodes[n];
    const bool has_parent = node.parent >= 0;
    const auto parent = static_cast<std::size_t>(std::max(node.parent, 0));
    const bool even_above = !has_parent || even[parent];
    even[n] = even_above && is_even(node);
    if (has_parent) ways[n] = ways[parent];
    if (!motions[n].moves) continue;
    if (motions[n].scales || (motions[n].turns && !even_above)) ways[n] = InstanceMotion::kDeforms;
    if (ways[n] == InstanceMotion::kRests) ways[n] = InstanceMotion::kRigid;
  }
  return ways;
}

/// Leaves the largest so many of those that move.
void keep_largest(const SceneSource& source, std::vector<InstanceMotion>& motions) {
  std::vector<std::uint32_t> movers;
  for (std::uint32_t i = 0; i < motions.size(); ++i) {
    if (motions[i] != InstanceMotion::kRests) movers.push_back(i);
  }
  if (movers.size() <= kMostMovers) return;
  const auto size = [&](std::uint32_t i) { return source.meshes[source.instances[i].mesh].indices.size(); };
  std::ranges::stable_sort(movers, [&](std::uint32_t a, std::uint32_t b) { return size(a) > size(b); });
  spdlog::warn("{}: {} instances move, the {} largest are shown so", source.name, movers.size(), kMostMovers);
  for (std::size_t i = kMostMovers; i < movers.size(); ++i) motions[movers[i]] = InstanceMotion::kRests;
}

}  // namespace

std::vector<InstanceMotion> find_movers(const SceneSource& source) {
  std::vector<InstanceMotion> motions(source.instances.size(), InstanceMotion::kRests);
  const Rig& rig = source.rig;
  if (!rig.moves()) return motions;
  const std::vector<InstanceMotion> ways = ways_of(rig);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const bool deforms = rig.instances[i].skin >= 0 || !rig.meshes[source.instances[i].mesh].morphs.empty();
    motions[i] = deforms ? InstanceMotion::kDeforms : ways[rig.instances[i].node];
  }
  keep_largest(source, motions);
  return motions;
}

}  // namespace atlaswire::render
