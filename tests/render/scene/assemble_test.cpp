#include "render/scene/assemble.h"

#include "render/scene/light_lists.h"
#include "render/scene/load.h"
#include "render/scene/scene_error.h"
#include "render/scene/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace atlaswire::render {
namespace {

SceneSource one_box(const glm::dmat4& where = glm::dmat4(1.0)) {
  SceneSource source;
  source.name = "box";
  source.materials.resize(1);
  source.meshes.push_back(box({0, 0, 0}, {1, 2, 3}, 0.5F, 1.0F));
  source.instances.push_back({0, where});
  return source;
}

glm::vec3 face_normal(const Scene& scene, std::size_t triangle) {
  const auto at = [&](std::size_t c) { return scene.vertices[scene.indices[triangle * 3 + c]].position; };
  return glm::cross(at(1) - at(0), at(2) - at(0));
}

TEST(Assemble, ChunksCoverAllPatchesAndTrianglesInOrder) {
  const auto scene = load_scene("atrium:0.02:plants");
  ASSERT_TRUE(scene.has_value());
  std::uint32_t patch = 0;
  std::uint32_t triangle = 0;
  std::vector<bool> drawn(scene->patches.size(), false);
  for (const Chunk& chunk : scene->chunks) {
    ASSERT_EQ(chunk.first_patch, patch);
    ASSERT_EQ(chunk.first_triangle, triangle);
    ASSERT_LE(chunk.triangle_count, AssembleSettings{}.chunk_triangles);
    const auto patches = patches_of(*scene, chunk);
    ASSERT_TRUE(std::ranges::is_sorted(patches));
    for (const std::uint32_t p : patches) {
      ASSERT_EQ(scene->patches[p].material, chunk.material);
      ASSERT_FALSE(drawn[p]) << "patch " << p;
      drawn[p] = true;
    }
    for (std::uint32_t t = triangle; t < triangle + chunk.triangle_count; ++t) {
      ASSERT_TRUE(std::ranges::binary_search(patches, scene->triangle_patch[t]));
      for (std::size_t c = 0; c < 3; ++c) {
        const glm::vec3 p = scene->vertices[scene->indices[t * 3 + c]].position;
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(p, chunk.box.low)) &&
                    glm::all(glm::lessThanEqual(p, chunk.box.high)));
      }
    }
    patch += chunk.patch_count;
    triangle += chunk.triangle_count;
  }
  EXPECT_EQ(patch, scene->patches.size());
  EXPECT_EQ(triangle * 3, scene->indices.size());
}

TEST(Assemble, ChunksOfASheetAreCompactAndFull) {
  // A sheet of 100 x 100 squares: chunks of 128 of them cannot have less outline than 11.3 x 11.3 ones.
  SceneSource source;
  source.name = "sheet";
  source.materials.resize(1);
  source.instances.push_back({0, glm::dmat4(1.0)});
  SourceMesh sheet;
  for (int y = 0; y <= 100; ++y) {
    for (int x = 0; x <= 100; ++x) {
      sheet.vertices.emplace_back();
      sheet.vertices.back().position = {x, y, 0};
      sheet.vertices.back().normal = {0, 0, 1};
    }
  }
  for (std::uint32_t y = 0; y < 100; ++y) {
    for (std::uint32_t x = 0; x < 100; ++x) {
      const std::uint32_t a = y * 101 + x;
      sheet.indices.insert(sheet.indices.end(), {a, a + 1, a + 102, a, a + 102, a + 101});
    }
  }
  source.meshes.push_back(std::move(sheet));
  const auto scene = assemble(std::move(source));
  ASSERT_TRUE(scene.has_value());
  EXPECT_LE(scene->chunks.size(), 20'000U / 200);
  double area = 0;
  for (const Chunk& chunk : scene->chunks) {
    const glm::vec3 side = chunk.box.high - chunk.box.low;
    area += side.x * side.y;
    EXPECT_LT(side.x + side.y, 32.0F);
  }
  EXPECT_LT(area, 1.15 * 100 * 100) << "boxes overlap little";
}

TEST(Assemble, PatchesAreSortedByClassAndMaterial) {
  const auto scene = load_scene("atrium:0.02:plants");
  ASSERT_TRUE(scene.has_value());
  for (std::size_t p = 1; p < scene->patches.size(); ++p) {
    const Material& before = scene->materials[scene->patches[p - 1].material];
    const Material& now = scene->materials[scene->patches[p].material];
    ASSERT_LE(before.draw.alpha, now.draw.alpha);
  }
}

TEST(Assemble, LightListsNameEveryLightThatReaches) {
  const auto scene = load_scene("atrium:0.02:lights=100");
  ASSERT_TRUE(scene.has_value());
  ASSERT_EQ(scene->lights.size(), 100U);
  for (const Chunk& chunk : scene->chunks) {
    std::vector<std::uint32_t> wanted;
    for (std::uint32_t i = 0; i < scene->lights.size(); ++i) {
      if (reaches(scene->lights[i], chunk.box)) wanted.push_back(i);
    }
    const auto* first = scene->light_lists.data() + chunk.first_light;
    EXPECT_EQ(std::vector<std::uint32_t>(first, first + chunk.light_count), wanted);
  }
}

TEST(Assemble, ADistantSceneIsTheSameAroundItsOrigin) {
  const auto near = assemble(one_box());
  const auto far = assemble(one_box(glm::translate(glm::dmat4(1.0), glm::dvec3(1e6, -2e6, 3e6))));
  ASSERT_TRUE(near.has_value() && far.has_value());
  ASSERT_EQ(far->positions.size(), near->positions.size());
  for (std::size_t i = 0; i < near->positions.size(); ++i) EXPECT_EQ(far->positions[i], near->positions[i]);
  EXPECT_EQ(far->origin - near->origin, glm::dvec3(1e6, -2e6, 3e6));
}

TEST(Assemble, WeldsPointsAcrossSeams) {
  const auto scene = assemble(one_box());
  ASSERT_TRUE(scene.has_value());
  EXPECT_GT(scene->vertices.size(), scene->positions.size())
      << "corners of a box have three normals, one position";
  for (const Patch& patch : scene->patches) {
    for (std::size_t c = 0; c < kMaxPatchCorners; ++c) {
      EXPECT_EQ(scene->positions[value(patch.positions[c])], scene->vertices[patch.vertices[c]].position);
    }
  }
}

TEST(Assemble, MirroringKeepsFrontsOutside) {
  for (const glm::dvec3 scale : {glm::dvec3(1, 1, 1), glm::dvec3(-1, 1, 1), glm::dvec3(2, -3, -1)}) {
    const auto scene = assemble(one_box(glm::scale(glm::dmat4(1.0), scale)));
    ASSERT_TRUE(scene.has_value());
    for (std::size_t t = 0; t < scene->indices.size() / 3; ++t) {
      const ShadingVertex& v = scene->vertices[scene->indices[t * 3]];
      const glm::vec3 front = face_normal(*scene, t);
      EXPECT_GT(glm::dot(front, v.position), 0.0F) << "a convex box around its centre";
      EXPECT_GT(glm::dot(front, unpack_normal(v.normal)), 0.0F);
    }
  }
}

TEST(Assemble, DegenerateTrianglesAreCountedAndDropped) {
  SceneSource source = one_box();
  source.meshes[0].indices.insert(source.meshes[0].indices.end(), {0, 0, 1, 0, 1, 1});
  const auto scene = assemble(std::move(source));
  ASSERT_TRUE(scene.has_value());
  EXPECT_EQ(scene->requirements.degenerate_triangles, 2U);
}

TEST(Assemble, RefusesNothingAndNotFinite) {
  SceneSource empty;
  EXPECT_EQ(assemble(empty).error().code, SceneError::kEmpty);
  SceneSource nan = one_box();
  nan.meshes[0].vertices[3].position.y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(assemble(nan).error().code, SceneError::kNotFinite);
  SceneSource flat = one_box(glm::scale(glm::dmat4(1.0), glm::dvec3(0, 0, 0)));
  EXPECT_EQ(assemble(flat).error().code, SceneError::kEmpty);
}

TEST(PackNormal, RoundTripsWithinAThousandthOfARadian) {
  for (int i = 0; i < 2000; ++i) {
    const float z = -1.0F + 2.0F * (static_cast<float>(i) + 0.5F) / 2000.0F;
    const float angle = 2.399963F * static_cast<float>(i);
    const float r = std::sqrt(1.0F - z * z);
    const glm::vec3 n(r * std::cos(angle), r * std::sin(angle), z);
    EXPECT_LT(glm::length(glm::cross(unpack_normal(pack_normal(n)), n)), 1e-3F);
    EXPECT_GT(glm::dot(unpack_normal(pack_normal(n)), n), 0.0F);
  }
}

}  // namespace
}  // namespace atlaswire::render
