#pragma once

#include "base/result.h"
#include "render/scene/source.h"

#include <cstdint>
#include <vector>

namespace atlaswire::render {

/// All instances' triangles in scene space, equal vertices made one.
struct FlatMesh {
  glm::dvec3 origin{0.0};
  Box box;  ///< relative to origin
  std::vector<ShadingVertex> vertices;
  std::vector<std::uint32_t> indices;    ///< 3 a triangle; none degenerate
  std::vector<std::uint16_t> materials;  ///< by triangle
  std::vector<std::uint32_t> objects;    ///< by triangle
  std::uint32_t degenerate_triangles = 0;
};

/// Places every instance. Vertices whose packed members are all equal become one. A mirroring transform flips
/// winding and tangents. Errors: kNotFinite, kEmpty, kTooLarge.
Result<FlatMesh> flatten(const SceneSource& source);

/// Welds equal points: gives one number a vertex and appends the distinct points to `positions`.
std::vector<VertexId> weld(const std::vector<ShadingVertex>& vertices, std::vector<glm::vec3>& positions);

}  // namespace atlaswire::render
