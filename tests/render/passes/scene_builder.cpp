#include "tests/render/passes/scene_builder.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace atlaswire::render::test {

SceneBuilder::SceneBuilder() {
  scene.name = "test";
  scene.ambient_up = scene.ambient_down = glm::vec3{0.0F};
}

std::uint16_t SceneBuilder::material(const Material& material) {
  scene.materials.push_back(material);
  return static_cast<std::uint16_t>(scene.materials.size() - 1);
}

std::int32_t SceneBuilder::texture(Texture texture) {
  scene.textures.push_back(std::move(texture));
  return static_cast<std::int32_t>(scene.textures.size() - 1);
}

void SceneBuilder::patch(std::uint16_t material, std::span<const glm::vec3> corners,
                         std::span<const glm::vec2> uvs) {
  pending_.push_back({material, {corners.begin(), corners.end()}, {uvs.begin(), uvs.end()}});
}

void SceneBuilder::rectangle(std::uint16_t material, const glm::vec3& corner, const glm::vec3& right,
                             const glm::vec3& up) {
  const std::array<glm::vec3, 4> corners{corner, corner + right, corner + right + up, corner + up};
  const std::array<glm::vec2, 4> uvs{glm::vec2{0, 1}, glm::vec2{1, 1}, glm::vec2{1, 0}, glm::vec2{0, 0}};
  patch(material, corners, uvs);
}

void SceneBuilder::add(const Pending& p) {
  const auto triangles = static_cast<std::uint32_t>(p.corners.size() - 2);
  Patch patch{.material = p.material, .triangles = static_cast<std::uint8_t>(triangles)};
  const glm::vec3 along = p.corners[1] - p.corners[0];
  const glm::vec3 normal = glm::normalize(glm::cross(along, p.corners.back() - p.corners[0]));
  for (std::size_t c = 0; c < kMaxPatchCorners; ++c) {
    if (c < p.corners.size()) {
      scene.vertices.push_back({.position = p.corners[c],
                                .normal = pack_normal(normal),
                                .tangent = pack_tangent(glm::normalize(along), false),
                                .uv = p.uvs[c]});
      scene.positions.push_back(p.corners[c]);
    }
    patch.vertices[c] = static_cast<std::uint32_t>(scene.vertices.size() - 1);
    patch.positions[c] = static_cast<VertexId>(scene.positions.size() - 1);
  }
  for (std::uint32_t t = 0; t < triangles; ++t) {
    for (const std::uint8_t c : patch_triangle(triangles, t)) scene.indices.push_back(patch.vertices[c]);
    scene.triangle_patch.push_back(static_cast<std::uint32_t>(scene.patches.size()));
  }
  Chunk& chunk = scene.chunks.back();
  for (const glm::vec3& corner : p.corners) {
    chunk.box.low =
        chunk.patch_count == 0 && corner == p.corners[0] ? corner : glm::min(chunk.box.low, corner);
    chunk.box.high =
        chunk.patch_count == 0 && corner == p.corners[0] ? corner : glm::max(chunk.box.high, corner);
  }
  ++chunk.patch_count;
  chunk.triangle_count += triangles;
  scene.drawn.push_back(static_cast<std::uint32_t>(scene.patches.size()));
  scene.patches.push_back(patch);
}

std::shared_ptr<const Scene> SceneBuilder::build() {
  std::ranges::stable_sort(pending_, {}, &Pending::material);
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) scene.light_lists.push_back(i);
  for (const Pending& p : pending_) {
    if (scene.chunks.empty() || scene.chunks.back().material != p.material) {
      scene.chunks.push_back({.first_patch = static_cast<std::uint32_t>(scene.patches.size()),
                              .first_triangle = static_cast<std::uint32_t>(scene.indices.size() / 3),
                              .light_count = static_cast<std::uint32_t>(scene.lights.size()),
                              .material = p.material});
    }
    add(p);
  }
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    scene.box.low = i == 0 ? scene.positions[i] : glm::min(scene.box.low, scene.positions[i]);
    scene.box.high = i == 0 ? scene.positions[i] : glm::max(scene.box.high, scene.positions[i]);
  }
  for (const Material& m : scene.materials) {
    scene.requirements.alpha_mask = scene.requirements.alpha_mask || m.draw.alpha == PatchClass::Alpha::kMask;
    scene.requirements.alpha_blend =
        scene.requirements.alpha_blend || m.draw.alpha == PatchClass::Alpha::kBlend;
  }
  return std::make_shared<const Scene>(scene);
}

Material glowing(const glm::vec3& emissive) {
  return {.name = "glowing", .base_color = {0.0F, 0.0F, 0.0F, 1.0F}, .emissive = emissive};
}

}  // namespace atlaswire::render::test
