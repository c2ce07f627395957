#pragma once

#include "render/gpu/buffer.h"
#include "render/gpu/submit_context.h"
#include "render/passes/visibility_mesh.h"
#include "render/scene/scene.h"

namespace atlaswire::render {

/// What the visibility passes read of a scene beside SceneGpu, and what they write for each patch.
struct VisibilityGeometry {
  VisibilityGeometry(Device& device, const Scene& scene);

  VisibilityGeometry(Device& device, const Scene& scene, const IdMesh& mesh);

  Buffer solid;       ///< IdMesh
  Buffer cut;         ///< IdMesh
  Buffer indices;     ///< IdMesh
  Buffer positions;   ///< Scene::positions, 3 floats each
  Buffer corners;     ///< visibility::PatchCorners by patch
  Buffer marks;       ///< a word a patch: not 0 if seen in this frame; 0 between frames
  Buffer held;        ///< a word a patch: frames for which it still counts as visible
  Buffer list;        ///< visibility::kListHeader words, then the marked patches in no order
  Buffer priorities;  ///< surface_priorities, written by the host; 0 at first
  Buffer levels;      ///< a word a patch, for the host
};

}  // namespace atlaswire::render
