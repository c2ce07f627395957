#include "render/scene/assemble.h"

#include "render/scene/flatten.h"
#include "render/scene/light_lists.h"
#include "render/scene/scene_error.h"
#include "render/scene/subdivide.h"

#include <algorithm>
#include <glm/common.hpp>
#include <limits>
#include <tuple>

namespace atlaswire::render {

namespace {

/// Interleaves 10 bits of each axis.
std::uint32_t morton(const glm::vec3& unit) {
  std::uint32_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::uint32_t>(glm::clamp(unit[axis], 0.0F, 1.0F) * 1023.0F);
    for (std::uint32_t bit = 0; bit < 10; ++bit)
      code |= ((cell >> bit) & 1U) << (3 * bit + static_cast<std::uint32_t>(axis));
  }
  return code;
}

struct SortedGroup {
  std::uint8_t draw_class = 0;
  std::uint16_t material = 0;
  std::uint32_t code = 0;
  std::uint32_t group = 0;
  [[nodiscard]] auto key() const { return std::make_tuple(draw_class, material, code, group); }
};

std::uint8_t class_rank(const PatchClass& c) {
  return static_cast<std::uint8_t>(static_cast<unsigned>(c.alpha) * 2 + (c.double_sided ? 1 : 0));
}

std::vector<SortedGroup> order(const FlatMesh& flat, const std::vector<TriangleGroup>& groups,
                               const std::vector<Material>& materials) {
  std::vector<SortedGroup> out;
  out.reserve(groups.size());
  const glm::vec3 size = glm::max(flat.box.high - flat.box.low, glm::vec3(1e-20F));
  const float longest = std::max({size.x, size.y, size.z});
  for (std::uint32_t g = 0; g < groups.size(); ++g) {
    const TriangleGroup& group = groups[g];
    const std::uint16_t material = flat.materials[group.triangle];
    const glm::vec3 middle =
        0.5F * (flat.vertices[group.corners[0]].position + flat.vertices[group.corners[2]].position);
    out.push_back(
        {class_rank(materials[material].draw), material, morton((middle - flat.box.low) / longest), g});
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.key() < b.key(); });
  return out;
}

/// Vertices in order of first use by patches, so that neighbours in memory are neighbours in space.
void renumber_vertices(const FlatMesh& flat, const std::vector<TriangleGroup>& groups,
                       const std::vector<SortedGroup>& sorted, Scene& scene) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> numbers(flat.vertices.size(), kUnused);
  scene.vertices.reserve(flat.vertices.size());
  scene.patches.reserve(sorted.size());
  for (const SortedGroup& s : sorted) {
    const TriangleGroup& group = groups[s.group];
    Patch patch;
    patch.material = s.material;
    patch.triangles = group.count;
    for (std::size_t c = 0; c < kMaxPatchCorners; ++c) {
      std::uint32_t& number = numbers[group.corners[c]];
      if (number == kUnused) {
        number = static_cast<std::uint32_t>(scene.vertices.size());
        scene.vertices.push_back(flat.vertices[group.corners[c]]);
      }
      patch.vertices[c] = number;
    }
    scene.patches.push_back(patch);
  }
  const std::vector<VertexId> welded = weld(scene.vertices, scene.positions);
  for (Patch& patch : scene.patches) {
    for (std::size_t c = 0; c < kMaxPatchCorners; ++c) patch.positions[c] = welded[patch.vertices[c]];
  }
}

void list_triangles(Scene& scene) {
  for (std::uint32_t p = 0; p < scene.patches.size(); ++p) {
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

void cut_chunks(Scene& scene, std::uint32_t most_triangles) {
  std::uint32_t triangle = 0;
  for (std::uint32_t p = 0; p < scene.patches.size(); ++p) {
    const Patch& patch = scene.patches[p];
    const bool fits = !scene.chunks.empty() && scene.chunks.back().material == patch.material &&
                      scene.chunks.back().triangle_count + patch.triangles <= most_triangles;
    if (!fits) {
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
  for (SourceMesh& mesh : source.meshes) {
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

}  // namespace

Result<Scene> assemble(SceneSource source, const AssembleSettings& settings) {
  std::uint32_t split = 0;
  if (settings.split_huge_triangles) split = split_huge_triangles(source);
  auto flattened = flatten(source);
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
  renumber_vertices(flat, groups, order(flat, groups, scene.materials), scene);
  list_triangles(scene);
  cut_chunks(scene, settings.chunk_triangles);
  list_lights(scene);
  scene.requirements = require(scene, flat.degenerate_triangles, split);
  return scene;
}

}  // namespace atlaswire::render
