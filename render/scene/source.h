#pragma once

#include "render/scene/rig.h"
#include "render/scene/scene.h"

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

namespace atlaswire::render {

/// A vertex in its mesh's own space.
struct SourceVertex {
  glm::vec3 position{0.0F};
  glm::vec3 normal{0.0F};
  glm::vec4 tangent{0.0F};  ///< xyz along +u; w = +-1 so that bitangent = cross(normal, tangent) * w
  glm::vec2 uv{0.0F};
  std::uint32_t rig = 0;  ///< which of RigMesh's entries moves it
};

/// Triangles of one material before they are placed. Indices must be below vertices.size(): who makes one
/// checks them.
struct SourceMesh {
  std::uint16_t material = 0;
  std::vector<SourceVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< 3 a triangle, counter-clockwise in front
};

/// A mesh placed in the scene. A mirroring transform flips the winding.
struct SourceInstance {
  std::uint32_t mesh = 0;
  glm::dmat4 to_scene{1.0};
  std::uint32_t object = 0;  ///< into SceneSource::objects, unless there are none
};

/// A light before the scene's origin is known.
struct SourceLight {
  glm::dvec3 position{0.0};
  PunctualLight light;  ///< its position is ignored
};

/// What loaders and generators hand to `assemble`: plain meshes, instances and looks.
struct SceneSource {
  std::string name;
  std::vector<SourceMesh> meshes;
  std::vector<SourceInstance> instances;
  std::vector<Material> materials;
  std::vector<SceneObject> objects;
  std::vector<Texture> textures;
  std::vector<SourceLight> lights;
  Sun sun;
  glm::vec3 ambient_up{0.3F};
  glm::vec3 ambient_down{0.1F};
  glm::vec3 background{0.0F};
  float exposure = 1.0F;
  Pose start;
  Rig rig;
};

/// Normals where every one of the mesh's is zero: of faces when `flat` (vertices are split), else smoothed
/// over the vertices' triangles, each weighted by area and angle.
void compute_normals(SourceMesh& mesh, bool flat);

/// Tangents per vertex from positions, normals and uv (Lengyel), orthonormal to the normals. Vertices where
/// mirrored and unmirrored mappings meet are split, so that each has one handedness.
void compute_tangents(SourceMesh& mesh);

}  // namespace atlaswire::render
