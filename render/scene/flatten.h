#pragma once

#include "base/result.h"
#include "render/scene/find_movers.h"
#include "render/scene/source.h"

#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::render {

/// Where a vertex of something that moves comes from.
struct VertexOrigin {
  std::uint32_t instance = 0;  ///< 1 + its number; 0: it rests, and the others say nothing
  std::uint32_t vertex = 0;    ///< of the instance's mesh
  std::uint32_t apart = 0;     ///< points of different numbers may part although they rest at one place
};

/// All instances' triangles in scene space, equal vertices made one.
struct FlatMesh {
  glm::dvec3 origin{0.0};
  Box box;  ///< relative to origin
  std::vector<ShadingVertex> vertices;
  std::vector<std::uint32_t> indices;    ///< 3 a triangle; none degenerate
  std::vector<std::uint16_t> materials;  ///< by triangle
  std::vector<std::uint32_t> objects;    ///< by triangle
  std::uint32_t degenerate_triangles = 0;
  // Empty where nothing moves.
  std::vector<VertexOrigin> origins;     ///< by vertex
  std::vector<std::uint32_t> instances;  ///< by triangle: 1 + the instance that moves it, or 0
};

/// Places every instance. Vertices whose packed members are all equal become one, unless they may move apart.
/// A mirroring transform flips winding and tangents. `motions`: one an instance. Errors: kNotFinite, kEmpty,
/// kTooLarge.
Result<FlatMesh> flatten(const SceneSource& source, std::span<const InstanceMotion> motions);

/// Welds equal points that do not move apart (`origins` by vertex; empty: none does): gives one number a
/// vertex and appends the distinct points to `positions`.
std::vector<VertexId> weld(const std::vector<ShadingVertex>& vertices, std::span<const VertexOrigin> origins,
                           std::vector<glm::vec3>& positions);

}  // namespace atlaswire::render
