#pragma once

#include "base/mover.h"
#include "render/scene/find_movers.h"
#include "render/scene/source.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace atlaswire::render {

/// Neighbouring numbers.
struct NumberRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;

  [[nodiscard]] std::uint32_t end() const { return first + count; }
};

/// What one instance moves: a run of patches, and what they alone use.
struct MovingPart {
  Mover mover;
  std::uint32_t instance = 0;  ///< of SceneMotion::source
  NumberRange chunks;
  NumberRange triangles;
  NumberRange vertices;
  NumberRange positions;
  std::vector<std::uint32_t> points;   ///< by vertex of the part: its position, counted within the part
  std::vector<std::uint32_t> sources;  ///< by position of the part: the mesh's vertex; only if it deforms
};

/// All that moves in a scene, and how.
struct SceneMotion {
  SceneSource source;  ///< rig, instances, and the vertices of what deforms; no triangles, no looks
  std::vector<MovingPart> parts;       ///< ascending
  std::vector<std::uint32_t> objects;  ///< by number of a rigid object: an instance that goes with it
};

/// Lists what moves. `scene` is whole but for its motion; `instances`: by patch, 1 + the one that moves it or
/// 0; `sources`: by Scene::vertices, the mesh's vertex. `motions`: one an instance. Null: nothing moves.
std::shared_ptr<const SceneMotion> list_motion(const Scene& scene, std::span<const std::uint32_t> instances,
                                               std::span<const std::uint32_t> sources,
                                               std::span<const InstanceMotion> motions, SceneSource source);

}  // namespace atlaswire::render
