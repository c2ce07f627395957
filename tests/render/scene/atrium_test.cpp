#include "render/scene/atrium.h"

#include "render/scene/load.h"
#include "render/scene/scene_error.h"

#include <gtest/gtest.h>

#include <cstring>

namespace atlaswire::render {
namespace {

TEST(Atrium, IsAboutAQuarterMillionTrianglesInPairs) {
  const auto scene = load_scene("atrium");
  ASSERT_TRUE(scene.has_value());
  const SceneRequirements& r = scene->requirements;
  EXPECT_NEAR(r.triangles, 250'000, 30'000);
  EXPECT_GE(scene->textures.size(), 20U);
  EXPECT_EQ(r.lights, 16U);
  EXPECT_TRUE(r.sun && r.normal_maps && r.double_sided);
  EXPECT_FALSE(r.alpha());
  EXPECT_GT(r.patches_of[2], 0.99 * (r.patches_of[1] + r.patches_of[2] + r.patches_of[3]));
}

TEST(Atrium, IsTheSameEachTime) {
  const auto a = load_scene("atrium:0.02");
  const auto b = load_scene("atrium:0.02");
  ASSERT_TRUE(a.has_value() && b.has_value());
  ASSERT_EQ(a->vertices.size(), b->vertices.size());
  EXPECT_EQ(std::memcmp(a->vertices.data(), b->vertices.data(), a->vertices.size() * sizeof(ShadingVertex)),
            0);
  EXPECT_EQ(a->indices, b->indices);
  for (std::size_t t = 0; t < a->textures.size(); ++t) EXPECT_EQ(a->textures[t].rgba, b->textures[t].rgba);
}

TEST(Atrium, DetailScalesItsTriangles) {
  AssembleSettings as_made;
  as_made.split_huge_triangles = false;
  const auto small = load_scene("atrium:0.02", as_made);
  const auto middle = load_scene("atrium:0.3", as_made);
  ASSERT_TRUE(small.has_value() && middle.has_value());
  EXPECT_LT(small->requirements.triangles, 40'000U);
  EXPECT_GT(middle->requirements.triangles, 2 * small->requirements.triangles);
}

TEST(Atrium, PlantsNeedACoveragePlane) {
  const auto scene = load_scene("atrium:0.02:plants");
  ASSERT_TRUE(scene.has_value());
  EXPECT_TRUE(scene->requirements.alpha_mask);
  EXPECT_FALSE(scene->requirements.alpha_blend);
}

TEST(AtriumName, RefusesWhatItDoesNotKnow) {
  for (const char* name : {"atrium:", "atrium:3", "atrium:0.01", "atrium:lights=", "atrium:lights=401",
                           "atrium:lights=-1", "atrium:0.5x", "atrium:nan", "atrium:weeds"}) {
    const auto options = parse_atrium_name(name);
    ASSERT_TRUE(options.has_error()) << name;
    EXPECT_EQ(options.error().code, SceneError::kBadName) << name;
  }
  EXPECT_EQ(load_scene("atriums").error().code, SceneError::kNotFound);
}

}  // namespace
}  // namespace atlaswire::render
