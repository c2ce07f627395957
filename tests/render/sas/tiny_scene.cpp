#include "tests/render/sas/tiny_scene.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace atlaswire::render::test {

TinyScene::TinyScene(const glm::dvec3& origin) : scene_(std::make_shared<Scene>()) {
  scene_->name = "tiny";
  scene_->origin = origin;
}

void TinyScene::material(PatchClass draw, std::int32_t texture) {
  Material& material = scene_->materials.emplace_back();
  material.draw = draw;
  material.base_color_texture = texture;
  Chunk& chunk = scene_->chunks.emplace_back();
  chunk.material = static_cast<std::uint16_t>(scene_->materials.size() - 1);
  chunk.first_patch = static_cast<std::uint32_t>(scene_->patches.size());
  chunk.first_triangle = static_cast<std::uint32_t>(scene_->triangle_patch.size());
  chunk.box = {.low = glm::vec3(1e9F), .high = glm::vec3(-1e9F)};
  auto& requirements = scene_->requirements;
  requirements.alpha_mask |= draw.alpha == PatchClass::Alpha::kMask;
  requirements.alpha_blend |= draw.alpha == PatchClass::Alpha::kBlend;
  requirements.double_sided |= draw.double_sided;
  requirements.base_color_textures |= texture != kNoTexture;
}

std::int32_t TinyScene::texture(std::uint32_t side, std::vector<std::uint8_t> rgba) {
  scene_->textures.push_back(
      {.name = "tiny", .extent = {side, side}, .rgba = std::move(rgba), .srgb = true, .nearest = true});
  return static_cast<std::int32_t>(scene_->textures.size()) - 1;
}

PatchId TinyScene::patch(const std::vector<glm::vec3>& corners) {
  Scene& s = *scene_;
  const auto triangles = static_cast<std::uint32_t>(corners.size() - 2);
  const auto id = static_cast<std::uint32_t>(s.patches.size());
  Chunk& chunk = s.chunks.back();
  s.drawn.push_back(id);
  Patch& patch = s.patches.emplace_back();
  patch.material = chunk.material;
  patch.triangles = static_cast<std::uint8_t>(triangles);
  const glm::vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  for (std::uint32_t c = 0; c < kMaxPatchCorners; ++c) {
    if (c < corners.size()) {
      const auto [u, v] = corner_coordinate(triangles, c);
      s.vertices.push_back({.position = corners[c],
                            .normal = pack_normal(normal),
                            .tangent = pack_tangent(glm::normalize(corners[1] - corners[0]), false),
                            .uv = {u, v}});
      s.positions.push_back(corners[c]);
      chunk.box = {.low = glm::min(chunk.box.low, corners[c]), .high = glm::max(chunk.box.high, corners[c])};
    }
    patch.vertices[c] = static_cast<std::uint32_t>(s.vertices.size() - 1);
    patch.positions[c] = VertexId{static_cast<std::uint32_t>(s.positions.size() - 1)};
  }
  for (std::uint32_t t = 0; t < triangles; ++t) {
    for (const auto corner : patch_triangle(triangles, t)) s.indices.push_back(patch.vertices[corner]);
    s.triangle_patch.push_back(id);
  }
  ++chunk.patch_count;
  chunk.triangle_count += triangles;
  return PatchId{id};
}

PatchId TinyScene::wall(float left, float bottom, float right, float top, float z) {
  return patch({{left, bottom, z}, {right, bottom, z}, {right, top, z}, {left, top, z}});
}

std::shared_ptr<const Scene> TinyScene::finish() {
  Scene& s = *scene_;
  s.box = s.chunks.front().box;
  for (const Chunk& chunk : s.chunks) {
    s.box = {.low = glm::min(s.box.low, chunk.box.low), .high = glm::max(s.box.high, chunk.box.high)};
  }
  s.requirements.triangles = static_cast<std::uint32_t>(s.triangle_patch.size());
  return scene_;
}

}  // namespace atlaswire::render::test
