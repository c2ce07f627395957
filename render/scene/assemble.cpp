#include "render/scene/assemble.h"

#include "render/scene/chunk_order.h"
#include "render/scene/find_movers.h"
#include "render/scene/flatten.h"
#include "render/scene/light_lists.h"
#include "render/scene/moved_scene.h"
#include "render/scene/scene_error.h"
#include "render/scene/scene_motion.h"
#include "render/scene/subdivide.h"

#include <algorithm>
#include <glm/common.hpp>
#include <limits>
#include <span>
#include <utility>

namespace atlaswire::render {

namespace {

/// Patches in order of their numbers, and vertices in order of first use as they are drawn, so that
/// neighbours in memory are neighbours in space. Gives the vertices' origins, if anything moves.
std::vector<VertexOrigin> renumber_vertices(const FlatMesh& flat, const std::vector<TriangleGroup>& groups,
                                            const std::vector<OrderedGroup>& sorted, Scene& scene) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> numbers(flat.vertices.size(), kUnused);
  std::vector<VertexOrigin> origins;
  scene.vertices.reserve(flat.vertices.size());
  scene.patches.resize(sorted.size());
  scene.drawn.reserve(sorted.size());
  for (const OrderedGroup& s : sorted) {
    const TriangleGroup& group = groups[s.group];
    scene.drawn.push_back(s.patch);
    Patch& patch = scene.patches[s.patch];
    patch.material = s.material;
    patch.object = flat.objects[group.triangle];
    patch.triangles = group.count;
    for (std::size_t c = 0; c < kMaxPatchCorners; ++c) {
      std::uint32_t& number = numbers[group.corners[c]];
      if (number == kUnused) {
        number = static_cast<std::uint32_t>(scene.vertices.size());
        scene.vertices.push_back(flat.vertices[group.corners[c]]);
        if (!flat.origins.empty()) origins.push_back(flat.origins[group.corners[c]]);
      }
      patch.vertices[c] = number;
    }
  }
  const std::vector<VertexId> welded = weld(scene.vertices, origins, scene.positions);
  for (Patch& patch : scene.patches) {
    for (std::size_t c = 0; c < kMaxPatchCorners; ++c) patch.positions[c] = welded[patch.vertices[c]];
  }
  return origins;
}

void list_triangles(Scene& scene) {
  for (const std::uint32_t p : scene.drawn) {
    const Patch& patch = scene.patches[p];
    for (std::uint32_t t = 0; t < patch.triangles; ++t) {
      for (const std::uint8_t corner : patch_triangle(patch.triangles, t))
        scene.indices.push_back(patch.vertices[corner]);
      scene.triangle_patch.push_back(p);
    }
  }
}

void grow(Box& box, const glm::vec3& p) {
  box.low = glm::min(box.low, p);
  box.high = glm::max(box.high, p);
}

void list_chunks(const std::vector<OrderedGroup>& ordered, Scene& scene) {
  std::uint32_t triangle = 0;
  for (std::uint32_t p = 0; p < scene.drawn.size(); ++p) {
    const Patch& patch = scene.patches[scene.drawn[p]];
    if (ordered[p].chunk == scene.chunks.size()) {
      Chunk chunk;
      const glm::vec3 first = scene.vertices[patch.vertices[0]].position;
      chunk.box = {first, first};
      chunk.first_patch = p;
      chunk.first_triangle = triangle;
      chunk.material = patch.material;
      scene.chunks.push_back(chunk);
    }
    Chunk& chunk = scene.chunks.back();
    ++chunk.patch_count;
    chunk.triangle_count += patch.triangles;
    triangle += patch.triangles;
    for (std::uint32_t c = 0; c < corner_count(patch.triangles); ++c)
      grow(chunk.box, scene.vertices[patch.vertices[c]].position);
  }
}

/// Splits what is too large for one block; gives the triangles that it added.
std::uint32_t split_huge_triangles(SceneSource& source) {
  const float longest = suited_longest_edge(source);
  std::size_t before = 0;
  std::size_t after = 0;
  for (std::size_t m = 0; m < source.meshes.size(); ++m) {
    if (m < source.rig.meshes.size() && is_rigged(source.rig.meshes[m])) continue;
    SourceMesh& mesh = source.meshes[m];
    before += mesh.indices.size() / 3;
    subdivide(mesh, longest);
    after += mesh.indices.size() / 3;
  }
  return static_cast<std::uint32_t>(after - before);
}

SceneRequirements require(const Scene& scene, std::uint32_t degenerate, std::uint32_t split) {
  SceneRequirements r;
  r.split_triangles = split;
  std::vector<bool> used(scene.materials.size(), false);
  for (const Patch& patch : scene.patches) {
    used[patch.material] = true;
    ++r.patches_of[patch.triangles];
    r.triangles += patch.triangles;
  }
  for (std::size_t m = 0; m < used.size(); ++m) {
    if (!used[m]) continue;
    const Material& material = scene.materials[m];
    r.alpha_mask |= material.draw.alpha == PatchClass::Alpha::kMask;
    r.alpha_blend |= material.draw.alpha == PatchClass::Alpha::kBlend;
    r.double_sided |= material.draw.double_sided;
    r.base_color_textures |= material.base_color_texture != kNoTexture;
    r.normal_maps |= material.normal_texture != kNoTexture;
    r.metallic_roughness_textures |= material.metallic_roughness_texture != kNoTexture;
    r.emissive |= material.emissive != glm::vec3(0.0F);
  }
  r.sun = scene.sun.color != glm::vec3(0.0F);
  r.lights = static_cast<std::uint32_t>(scene.lights.size());
  for (const Chunk& chunk : scene.chunks)
    r.most_lights_per_chunk = std::max(r.most_lights_per_chunk, chunk.light_count);
  r.degenerate_triangles = degenerate;
  return r;
}

void count_motion(const Scene& scene, SceneRequirements& r) {
  if (!scene.motion) return;
  const SceneMotion& motion = *scene.motion;
  r.clips = static_cast<std::uint32_t>(motion.source.rig.clips.size());
  r.rigid_objects = static_cast<std::uint32_t>(motion.objects.size());
  for (const MovingPart& part : motion.parts) {
    if (!part.mover.deforms) continue;
    ++r.deformed_parts;
    r.deformed_points += part.positions.count;
  }
}

/// Finds what moves, and makes boxes of all places where it ever is.
void set_in_motion(const FlatMesh& flat, const std::vector<TriangleGroup>& groups,
                   const std::vector<OrderedGroup>& ordered, const std::vector<VertexOrigin>& origins,
                   std::span<const InstanceMotion> motions, SceneSource source, Scene& scene) {
  if (flat.instances.empty()) return;
  std::vector<std::uint32_t> instances;
  instances.reserve(ordered.size());
  for (const OrderedGroup& o : ordered) instances.push_back(flat.instances[groups[o.group].triangle]);
  std::vector<std::uint32_t> sources;
  sources.reserve(origins.size());
  for (const VertexOrigin& origin : origins) sources.push_back(origin.vertex);
  scene.motion = list_motion(scene, instances, sources, motions, std::move(source));
  if (scene.motion) sweep(scene);
}

}  // namespace

Result<Scene> assemble(SceneSource source, const AssembleSettings& settings) {
  std::uint32_t split = 0;
  if (settings.split_huge_triangles) split = split_huge_triangles(source);
  const std::vector<InstanceMotion> motions = find_movers(source);
  auto flattened = flatten(source, motions);
  if (flattened.has_error()) return flattened.error();
  const FlatMesh& flat = *flattened;
  if (source.materials.size() > std::numeric_limits<std::uint16_t>::max()) {
    return Error{SceneError::kTooLarge, source.name + ": more than 65535 materials"};
  }
  std::vector<glm::vec3> positions;
  positions.reserve(flat.vertices.size());
  for (const ShadingVertex& v : flat.vertices) positions.push_back(v.position);
  const auto groups = group_triangles({positions, flat.indices, flat.materials}, settings.patches);

  Scene scene;
  scene.name = std::move(source.name);
  scene.origin = flat.origin;
  scene.box = flat.box;
  scene.materials = std::move(source.materials);
  scene.objects = std::move(source.objects);
  scene.textures = std::move(source.textures);
  scene.sun = source.sun;
  scene.ambient_up = source.ambient_up;
  scene.ambient_down = source.ambient_down;
  scene.background = source.background;
  scene.exposure = source.exposure;
  scene.start = source.start;
  for (const SourceLight& light : source.lights) {
    scene.lights.push_back(light.light);
    scene.lights.back().position = glm::vec3(light.position - scene.origin);
  }
  const auto ordered = order_by_chunk(flat, groups, scene.materials, settings.chunk_triangles);
  const std::vector<VertexOrigin> origins = renumber_vertices(flat, groups, ordered, scene);
  list_triangles(scene);
  list_chunks(ordered, scene);
  set_in_motion(flat, groups, ordered, origins, motions, std::move(source), scene);
  list_lights(scene);
  scene.requirements = require(scene, flat.degenerate_triangles, split);
  count_motion(scene, scene.requirements);
  return scene;
}

}  // namespace atlaswire::render
