#include "render/passes/light_table.h"

#include <gtest/gtest.h>

#include <glm/packing.hpp>

namespace atlaswire::render {
namespace {

Scene scene_with(std::uint32_t lights) {
  Scene scene;
  for (std::uint32_t i = 0; i < lights; ++i) {
    scene.lights.push_back({.range = 2.0F, .color = glm::vec3{static_cast<float>(i + 1)}});
    scene.light_lists.push_back(i);
  }
  scene.chunks.push_back({.first_light = 0, .light_count = lights});
  return scene;
}

float red_of(const gpu_layout::LightConstants& light) { return glm::unpackHalf2x16(light.color_rg).x; }

TEST(LightTable, KeepsEveryLightThatFits) {
  const LightTable table = make_light_table(scene_with(3));
  EXPECT_EQ(table.dropped, 0U);
  ASSERT_EQ(table.lights.size(), 3U);
  EXPECT_EQ(table.chunk_ranges.at(0).count, 3U);
  EXPECT_EQ(red_of(table.lights[2]), 3.0F);
  EXPECT_EQ(glm::unpackHalf2x16(table.lights[0].color_b_inverse_range), glm::vec2(1.0F, 0.5F));
  EXPECT_FALSE(table.spots);
}

TEST(LightTable, DropsTheWeakestBeyondTheLimit) {
  const LightTable table = make_light_table(scene_with(gpu_layout::kMaxLights + 10));
  EXPECT_EQ(table.dropped, 10U);
  EXPECT_EQ(table.lights.size(), gpu_layout::kMaxLights);
  EXPECT_EQ(table.list.size(), gpu_layout::kMaxLights);
  for (const std::uint32_t at : table.list) {
    ASSERT_LT(at, table.lights.size());
    EXPECT_GT(red_of(table.lights[at]), 10.0F);
  }
}

TEST(LightTable, PointLightsShineAllRoundAndSpotsEndAtTheirCone) {
  Scene scene = scene_with(2);
  scene.lights[1].cos_outer = 0.5F;
  scene.lights[1].cos_inner = 0.75F;
  const LightTable table = make_light_table(scene);
  const auto cone = [&](std::size_t light, float cosine) {
    const glm::vec2 c = glm::unpackHalf2x16(table.lights[light].cone_scale_offset);
    return cosine * c.x + c.y;
  };
  EXPECT_TRUE(table.spots);
  EXPECT_EQ(cone(0, -1.0F), 1.0F);
  EXPECT_NEAR(cone(1, 0.5F), 0.0F, 1e-5F);
  EXPECT_NEAR(cone(1, 0.75F), 1.0F, 1e-5F);
}

}  // namespace
}  // namespace atlaswire::render
