#include "render/display/mesh_builder.h"

#include <gtest/gtest.h>

namespace atlaswire::render {
namespace {

DisplayPatch patch_of(std::uint32_t triangles, PatchClass draw, const Block& block) {
  DisplayPatch patch{static_cast<std::uint8_t>(triangles), draw, block, {}};
  for (std::uint32_t c = 0; c < corner_count(triangles); ++c) {
    patch.positions[c] = glm::vec3{static_cast<float>(c), 2.0F, 3.0F};
  }
  return patch;
}

constexpr PatchClass kOpaque{};

TEST(MeshBuilder, AtlasCoordinatesAreThoseOfCornerTexel) {
  for (std::uint32_t triangles = 1; triangles <= 3; ++triangles) {
    for (const bool transposed : {false, true}) {
      for (std::uint8_t w = 0; w <= 6; ++w) {
        for (std::uint8_t h = 0; h <= w; ++h) {
          const Block block{4032, 1000, w, h, transposed};
          MeshData mesh;
          build_mesh(std::array{patch_of(triangles, kOpaque, block)}, mesh);
          ASSERT_EQ(mesh.vertices.size(), corner_count(triangles));
          for (std::uint32_t c = 0; c < corner_count(triangles); ++c) {
            const glm::vec2 texel = corner_texel(block, triangles, c);
            EXPECT_EQ(static_cast<float>(mesh.vertices[c].half_texel_x) / 2.0F, texel.x);
            EXPECT_EQ(static_cast<float>(mesh.vertices[c].half_texel_y) / 2.0F, texel.y);
          }
        }
      }
    }
  }
}

TEST(MeshBuilder, GroupsPatchesByHowTheyAreDrawn) {
  using Alpha = PatchClass::Alpha;
  std::vector<DisplayPatch> patches;
  for (int round = 0; round < 2; ++round) {
    for (const Alpha alpha : {Alpha::kBlend, Alpha::kMask, Alpha::kOpaque}) {
      for (const bool double_sided : {true, false}) {
        for (std::uint32_t t = 1; t <= 3; ++t) patches.push_back(patch_of(t, {alpha, double_sided}, {}));
      }
    }
  }
  MeshData mesh;
  build_mesh(patches, mesh);
  EXPECT_EQ(mesh.indices.size(), 2U * 6 * 6 * 3);
  std::uint32_t expected_first = 0;
  for (const auto& sides : mesh.solid) {
    for (const auto& range : sides) {
      EXPECT_EQ(range.first, expected_first);
      EXPECT_EQ(range.count, 2U * 6 * 3);
      expected_first += range.count;
    }
  }
  ASSERT_EQ(mesh.blended.size(), 12U);
  for (const auto& blended : mesh.blended) EXPECT_GE(blended.range.first, expected_first);
  EXPECT_TRUE(mesh.blended[0].double_sided);
  EXPECT_FALSE(mesh.blended[3].double_sided);
  EXPECT_EQ(mesh.blended[1].range.count, 6U);
  EXPECT_EQ(mesh.blended[0].centre, glm::vec3(1, 2, 3));
  for (const std::uint32_t index : mesh.indices) ASSERT_LT(index, mesh.vertices.size());
}

TEST(MeshBuilder, TrianglesKeepTheirCornersAndWinding) {
  MeshData mesh;
  build_mesh(std::array{patch_of(1, kOpaque, {}), patch_of(3, kOpaque, {})}, mesh);
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 6, 4, 5, 6, 3, 6, 7}));
}

TEST(MeshBuilder, ReusesItsMemoryAndForgetsTheLastMesh) {
  const std::vector<DisplayPatch> many(100, patch_of(2, kOpaque, {}));
  MeshData mesh;
  build_mesh(many, mesh);
  const auto* const memory = mesh.vertices.data();
  build_mesh(std::span(many).first(3), mesh);
  EXPECT_EQ(mesh.vertices.data(), memory);
  EXPECT_EQ(mesh.indices.size(), 18U);
  build_mesh({}, mesh);
  EXPECT_TRUE(mesh.indices.empty());
  EXPECT_EQ(mesh.solid[0][0].count, 0U);
}

}  // namespace
}  // namespace atlaswire::render
