#pragma once

#include "render/scene/source.h"

#include <cstdint>
#include <vector>

namespace atlaswire::render {

/// How an instance of a scene with clips moves.
enum class InstanceMotion : std::uint8_t {
  kRests,
  kRigid,   ///< by rotations and translations alone
  kDeforms  ///< each vertex on its own way: skinned, morphed, or scaled as it goes
};

/// One for each instance; all rest in a scene without clips. Decided by what hangs above an instance: a clip
/// that scales it, or turns it below a node whose scale differs by axis, deforms it. At most kMostMovers
/// move: of more, those with the most triangles.
std::vector<InstanceMotion> find_movers(const SceneSource& source);

/// Has a mesh anything that deforms it? Its triangles are not to be split: a vertex between two others has no
/// rig.
inline bool is_rigged(const RigMesh& mesh) { return !mesh.joints.empty() || !mesh.morphs.empty(); }

}  // namespace atlaswire::render
