#pragma once

#include "render/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace atlaswire::render {

/// A vertex of the id pass: where, and the patch of the triangles that it leads.
struct IdVertex {
  glm::vec3 position;
  std::uint32_t patch;
};
static_assert(sizeof(IdVertex) == 16 && offsetof(IdVertex, patch) == 12);

/// The same for surfaces with holes or glass.
struct CutVertex {
  glm::vec3 position;
  std::uint32_t patch;
  glm::vec2 uv;
};
static_assert(sizeof(CutVertex) == 24 && offsetof(CutVertex, uv) == 16);

/// What a moving part has of an id mesh: a run of its vertices, and where each is from.
struct IdMeshPart {
  bool cut = false;                    ///< of IdMesh::cut, else of IdMesh::solid
  std::uint32_t first = 0;             ///< of its vertices
  std::vector<std::uint32_t> sources;  ///< by vertex: its position or vertex, counted within the part
};

/// A scene's triangles for the id pass, in the order of Scene::indices. The first vertex of a triangle tells
/// its patch by flat interpolation, so no shader needs a primitive's number: software devices would take
/// every triangle apart for it. Triangles are turned, and a few vertices doubled, so that no vertex must
/// lead two patches.
struct IdMesh {
  std::vector<IdVertex> solid;         ///< of opaque patches, from Scene::positions
  std::vector<CutVertex> cut;          ///< of masked and blended ones, from Scene::vertices
  std::vector<std::uint32_t> indices;  ///< three a triangle, into `solid` or `cut` by its patch's material
  std::vector<IdMeshPart> parts;       ///< by SceneMotion::parts
};
IdMesh make_id_mesh(const Scene& scene);

}  // namespace atlaswire::render
