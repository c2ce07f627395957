#pragma once

#include "base/ids.h"
#include "base/patch_layout.h"
#include "base/pose.h"
#include "base/units.h"
#include "render/scene/requirements.h"

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace atlaswire::render {

struct SceneMotion;

/// No texture.
inline constexpr std::int32_t kNoTexture = -1;

/// RGBA8 texels, row by row from the top; `srgb` says how colours are to be read. Mip levels are made on
/// the device.
struct Texture {
  std::string name;
  Extent2D extent;
  std::vector<std::uint8_t> rgba;
  bool srgb = true;
  bool repeat_u = true;  ///< else clamp to edge
  bool repeat_v = true;
  bool nearest = false;  ///< magnification filter
};

/// glTF 2.0 metallic-roughness. Texture members index Scene::textures.
struct Material {
  std::string name;
  glm::vec4 base_color{1.0F};  ///< linear
  float metallic = 0.0F;
  float roughness = 1.0F;
  glm::vec3 emissive{0.0F};  ///< linear
  float normal_scale = 1.0F;
  PatchClass draw;
  float alpha_cutoff = 0.5F;
  float atlas_priority =
      0.0F;  ///< -8..8 octaves of atlas area beside what the surface's size on screen asks for
  std::int32_t base_color_texture = kNoTexture;
  std::int32_t metallic_roughness_texture = kNoTexture;
  std::int32_t normal_texture = kNoTexture;
  std::int32_t emissive_texture = kNoTexture;
};

/// A named part of a scene file: what its nodes' meshes show.
struct SceneObject {
  std::string name;             ///< of the node, or the nearest above it that has one, else of the mesh
  float atlas_priority = 0.0F;  ///< as Material::atlas_priority, and added to it
  bool operator==(const SceneObject&) const = default;
};

/// What shading interpolates. Positions are relative to Scene::origin.
struct ShadingVertex {
  glm::vec3 position;
  std::uint32_t normal;   ///< octahedral, 2 x snorm16 (x in the low half)
  std::uint32_t tangent;  ///< octahedral, 2 x snorm15 with the low bit of each half unused but bit 0:
                          ///< handedness (1 = -1)
  glm::vec2 uv;
};
static_assert(sizeof(ShadingVertex) == 28);

/// Pack and unpack the two fields above; they mirror shaders/octahedral.glsl.
std::uint32_t pack_normal(const glm::vec3& n);
glm::vec3 unpack_normal(std::uint32_t packed);
std::uint32_t pack_tangent(const glm::vec3& t, bool negative_handed);
glm::vec3 unpack_tangent(std::uint32_t packed);
inline bool is_negative_handed(std::uint32_t packed_tangent) { return (packed_tangent & 1U) != 0; }

/// Unit of visibility and memory: 1..3 adjacent triangles of one material (base/patch_layout.h gives the
/// corner order; winding is the triangles' own, counter-clockwise in front).
struct Patch {
  std::array<std::uint32_t, kMaxPatchCorners> vertices{};  ///< into Scene::vertices; the rest repeat the last
  std::array<VertexId, kMaxPatchCorners> positions{};  ///< into Scene::positions; the rest repeat the last
  std::uint32_t object = 0;  ///< into Scene::objects, unless there are none: that of its lowest triangle
  std::uint16_t material = 0;
  std::uint8_t triangles = 1;
};

/// A box, relative to Scene::origin.
struct Box {
  glm::vec3 low{0.0F};
  glm::vec3 high{0.0F};
};

/// Neighbouring patches of one material, and of one instance if they move: unit of culling and of light
/// lists.
struct Chunk {
  Box box;                        ///< of what moves: all places where it ever is
  std::uint32_t first_patch = 0;  ///< into Scene::drawn
  std::uint32_t patch_count = 0;
  std::uint32_t first_triangle = 0;  ///< into Scene::indices / 3
  std::uint32_t triangle_count = 0;
  std::uint32_t first_light = 0;  ///< into Scene::light_lists
  std::uint32_t light_count = 0;
  std::uint16_t material = 0;
};

/// KHR_lights_punctual point or spot light, relative to Scene::origin. Luminous intensity in candela.
struct PunctualLight {
  glm::vec3 position{0.0F};
  float range = 10.0F;                     ///< metres, > 0; light ends there
  glm::vec3 color{1.0F};                   ///< linear colour times intensity
  float cos_outer = -2.0F;                 ///< -2: a point light
  glm::vec3 direction{0.0F, -1.0F, 0.0F};  ///< of a spot light
  float cos_inner = -2.0F;
};

/// The one directional light with a shadow.
struct Sun {
  glm::vec3 direction{0.0F, -1.0F, 0.0F};  ///< the way light travels, unit
  glm::vec3 color{0.0F};                   ///< linear colour times illuminance; 0: no sun
};

/// A scene ready for rendering: instances flattened into scene space, triangles grouped into patches,
/// patches numbered so that each material's lie together (opaque, then masked, then blended), each moving
/// instance's together within it, and neighbours follow each other (walk_order.h); drawn chunk by chunk. What
/// moves is at rest here (moved_scene.h). Immutable once made.
struct Scene {
  std::string name;
  glm::dvec3 origin{0.0};  ///< centre of the box at rest; float positions are relative to it
  Box box;                 ///< of all places where something ever is
  std::vector<ShadingVertex> vertices;
  std::vector<glm::vec3> positions;  ///< welded: one per distinct point that moves as one, relative to origin
  std::vector<Patch> patches;        ///< by PatchId
  std::vector<std::uint32_t> drawn;  ///< patches as they are drawn: a permutation, within each run of one
                                     ///< material and moving instance
  std::vector<std::uint32_t> indices;         ///< 3 a triangle into `vertices`, in the order of `drawn`
  std::vector<std::uint32_t> triangle_patch;  ///< patch of each triangle in `indices`
  std::vector<Chunk> chunks;                  ///< in the order of `drawn`, covering all
  std::vector<Material> materials;
  std::vector<SceneObject> objects;
  std::vector<Texture> textures;
  std::vector<PunctualLight> lights;
  std::vector<std::uint32_t> light_lists;  ///< lights that reach each chunk
  Sun sun;
  glm::vec3 ambient_up{0.3F};    ///< linear sky irradiance / pi from above
  glm::vec3 ambient_down{0.1F};  ///< and from below
  glm::vec3 background{0.0F};    ///< linear colour where nothing is drawn
  float exposure = 1.0F;         ///< multiplies radiance before tone mapping
  Pose start;                    ///< a sensible first view
  SceneRequirements requirements;
  std::shared_ptr<const SceneMotion> motion;  ///< null: nothing moves
};

/// The numbers of a chunk's patches, ascending.
inline std::span<const std::uint32_t> patches_of(const Scene& scene, const Chunk& chunk) {
  return std::span(scene.drawn).subspan(chunk.first_patch, chunk.patch_count);
}

}  // namespace atlaswire::render
