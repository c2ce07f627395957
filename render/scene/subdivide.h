#pragma once

#include "render/scene/source.h"

namespace atlaswire::render {

/// Splits every triangle with an edge longer than `longest` (metres in mesh space, > 0) at the middles of
/// such edges, again and again until none is left. Whether an edge is split depends on its two ends alone, so
/// neighbours stay joined, also across seams of normals and texture. A block has a largest size and one
/// resolution: without this, a wall of two triangles near the viewer would be blurred, and all of it shaded
/// where a corner is seen.
void subdivide(SourceMesh& mesh, float longest);

/// The edge length that splits a scene's huge triangles at a bounded price: 1.5 m, or as much more (by
/// doubling) as keeps the new triangles below about a third of the old, or 30000.
float suited_longest_edge(const SceneSource& source);

}  // namespace atlaswire::render
