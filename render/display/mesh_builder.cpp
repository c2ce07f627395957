#include "render/display/mesh_builder.h"

#include "base/assert.h"

namespace atlaswire::render {
namespace {

/// corner_texel in half texels: an integer, because corners lie at 0, 1/2 and 1 of the inset block.
std::uint16_t half_texels(std::uint32_t at, std::uint32_t side, float coordinate) {
  const auto halves = static_cast<std::uint32_t>(coordinate * 2.0F);
  return static_cast<std::uint16_t>(2 * at + 1 + halves * (side - 1));
}

std::size_t class_index(const PatchClass& draw) {
  return static_cast<std::size_t>(draw.alpha) * 2 + (draw.double_sided ? 1 : 0);
}

void write_vertices(const DisplayPatch& patch, DisplayVertex* to) {
  for (std::uint32_t c = 0; c < corner_count(patch.triangles); ++c) {
    auto [u, v] = corner_coordinate(patch.triangles, c);
    if (patch.block.transposed) std::swap(u, v);
    to[c] = {patch.positions[c], half_texels(patch.block.x, patch.block.width(), u),
             half_texels(patch.block.y, patch.block.height(), v)};
  }
}

glm::vec3 centre_of(const DisplayPatch& patch) {
  glm::vec3 sum{0.0F};
  const std::uint32_t corners = corner_count(patch.triangles);
  for (std::uint32_t c = 0; c < corners; ++c) sum += patch.positions[c];
  return sum / static_cast<float>(corners);
}

}  // namespace

void build_mesh(std::span<const DisplayPatch> patches, MeshData& mesh) {
  std::array<std::uint32_t, 6> indices_of{};
  std::uint32_t vertices = 0;
  for (const DisplayPatch& patch : patches) {
    AW_ASSERT(patch.triangles >= 1 && patch.triangles <= kMaxPatchTriangles);
    indices_of[class_index(patch.draw)] += patch.triangles * 3U;
    vertices += corner_count(patch.triangles);
  }
  std::array<std::uint32_t, 6> at{};
  for (std::size_t i = 1; i < at.size(); ++i) at[i] = at[i - 1] + indices_of[i - 1];
  for (std::size_t i = 0; i < 4; ++i) mesh.solid[i / 2][i % 2] = {at[i], indices_of[i]};
  mesh.vertices.resize(vertices);
  mesh.indices.resize(at.back() + indices_of.back());
  mesh.blended.clear();

  std::uint32_t vertex = 0;
  for (const DisplayPatch& patch : patches) {
    write_vertices(patch, &mesh.vertices[vertex]);
    std::uint32_t& next = at[class_index(patch.draw)];
    const std::uint32_t first = next;
    for (std::uint32_t t = 0; t < patch.triangles; ++t) {
      for (const std::uint8_t corner : patch_triangle(patch.triangles, t)) {
        mesh.indices[next++] = vertex + corner;
      }
    }
    if (patch.draw.alpha == PatchClass::Alpha::kBlend) {
      mesh.blended.push_back({centre_of(patch), {first, next - first}, patch.draw.double_sided});
    }
    vertex += corner_count(patch.triangles);
  }
}

}  // namespace atlaswire::render
