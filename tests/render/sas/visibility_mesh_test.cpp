#include "render/passes/visibility_mesh.h"

#include "base/random.h"
#include "tests/render/sas/tiny_scene.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace atlaswire::render {
namespace {

constexpr std::uint32_t kNone = ~0U;

/// Every triangle is led by its patch and is the scene's own, turned at most.
void expect_same_triangles(const Scene& scene, const IdMesh& mesh) {
  ASSERT_EQ(mesh.indices.size(), scene.indices.size());
  for (std::size_t t = 0; t < scene.triangle_patch.size(); ++t) {
    const std::uint32_t patch = scene.triangle_patch[t];
    const bool solid =
        scene.materials[scene.patches[patch].material].draw.alpha == PatchClass::Alpha::kOpaque;
    std::vector<glm::vec3> got;
    std::vector<glm::vec3> expected;
    for (std::size_t i = 3 * t; i < 3 * t + 3; ++i) {
      got.push_back(solid ? mesh.solid.at(mesh.indices[i]).position : mesh.cut.at(mesh.indices[i]).position);
      expected.push_back(scene.vertices[scene.indices[i]].position);
    }
    const std::uint32_t leader = mesh.indices[3 * t];
    EXPECT_EQ(solid ? mesh.solid[leader].patch : mesh.cut[leader].patch, patch) << "triangle " << t;
    std::ranges::rotate(expected, std::ranges::find(expected, got[0]));
    EXPECT_EQ(got, expected) << "triangle " << t;
  }
}

TEST(IdMesh, FirstVerticesLeadTheirPatches) {
  test::TinyScene builder;
  Random random(9);
  for (const auto alpha : {PatchClass::Alpha::kOpaque, PatchClass::Alpha::kMask, PatchClass::Alpha::kBlend}) {
    builder.material({.alpha = alpha});
    for (int i = 0; i < 30; ++i) {
      std::vector<glm::vec3> corners(3 + random.below(3));
      for (auto& c : corners) c = {random.uniform(), random.uniform(), random.uniform()};
      builder.patch(corners);
    }
  }
  const auto scene = builder.finish();
  const IdMesh mesh = make_id_mesh(*scene);
  expect_same_triangles(*scene, mesh);
  EXPECT_EQ(mesh.solid.size() + mesh.cut.size(), scene->vertices.size()) << "nothing is shared or doubled";
}

TEST(IdMesh, DoublesVerticesOnlyWherePatchesOutnumberThem) {
  // Eight triangles around one point, and each alone a patch: nine vertices for eight leaders.
  auto scene = std::make_shared<Scene>();
  scene->materials.emplace_back();
  scene->positions.emplace_back(0.0F);
  for (int i = 0; i < 8; ++i) scene->positions.emplace_back(i < 4 ? 1 : -1, i % 3, i % 2);
  for (const glm::vec3& p : scene->positions) scene->vertices.push_back({.position = p});
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t corners[3]{0, 1 + i, 1 + (i + 1) % 8};
    Patch& patch = scene->patches.emplace_back();
    for (std::uint32_t c = 0; c < kMaxPatchCorners; ++c) {
      patch.vertices[c] = corners[std::min(c, 2U)];
      patch.positions[c] = VertexId{corners[std::min(c, 2U)]};
    }
    scene->indices.insert(scene->indices.end(), std::begin(corners), std::end(corners));
    scene->triangle_patch.push_back(i);
    scene->drawn.push_back(i);
  }
  const IdMesh mesh = make_id_mesh(*scene);
  expect_same_triangles(*scene, mesh);
  EXPECT_LE(mesh.solid.size(), 10U);
  EXPECT_LE(std::ranges::count(mesh.solid, kNone, &IdVertex::patch), 2);
}

}  // namespace
}  // namespace atlaswire::render
