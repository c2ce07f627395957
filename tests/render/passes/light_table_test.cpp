#include "render/passes/light_table.h"

#include "tests/render/passes/scene_builder.h"

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

std::vector<std::uint32_t> listed(const LightTable& table, std::uint32_t at) {
  const auto first = table.lists.begin() + at + 1;
  return {first, first + table.lists.at(at)};
}

float red_of(const gpu_layout::LightConstants& light) { return glm::unpackHalf2x16(light.color_rg).x; }

TEST(LightTable, KeepsEveryLightThatFits) {
  const LightTable table = make_light_table(scene_with(3));
  EXPECT_EQ(table.dropped, 0U);
  ASSERT_EQ(table.lights.size(), 4U);
  EXPECT_EQ(listed(table, table.of_chunk.at(0)), (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(red_of(table.lights[3]), 3.0F);
  EXPECT_EQ(glm::unpackHalf2x16(table.lights[1].color_b_inverse_range), glm::vec2(1.0F, 0.5F));
  EXPECT_FALSE(table.spots);
}

TEST(LightTable, DropsTheWeakestBeyondTheLimit) {
  const LightTable table = make_light_table(scene_with(gpu_layout::kMaxLights + 10));
  EXPECT_EQ(table.dropped, 11U);
  EXPECT_EQ(table.lights.size(), gpu_layout::kMaxLights);
  const auto list = listed(table, table.of_chunk.at(0));
  EXPECT_EQ(list.size(), gpu_layout::kMaxLights - 1);
  for (const std::uint32_t at : list) {
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
  EXPECT_EQ(cone(1, -1.0F), 1.0F);
  EXPECT_NEAR(cone(2, 0.5F), 0.0F, 1e-5F);
  EXPECT_NEAR(cone(2, 0.75F), 1.0F, 1e-5F);
}

/// A unit square at z = 0 that faces +Z, with these lights in its chunk.
std::shared_ptr<const Scene> square_with(const std::vector<PunctualLight>& lights, bool double_sided) {
  test::SceneBuilder builder;
  builder.scene.lights = lights;
  Material material;
  material.draw.double_sided = double_sided;
  builder.rectangle(builder.material(material), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  return builder.build();
}

TEST(LightTable, PatchesListTheLightsThatReachThem) {
  const std::vector<PunctualLight> lights{{.position = {0.5F, 0.5F, 1}, .range = 1.5F},
                                          {.position = {0.5F, 0.5F, 2}, .range = 1.9F},    // too far
                                          {.position = {0.5F, 0.5F, -1}, .range = 1.5F}};  // behind
  const LightTable one = make_light_table(*square_with(lights, false));
  EXPECT_EQ(listed(one, one.of_chunk.at(0)), (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(listed(one, one.of_patch.at(0)), (std::vector<std::uint32_t>{1}));
  const LightTable both = make_light_table(*square_with(lights, true));
  EXPECT_EQ(listed(both, both.of_patch.at(0)), (std::vector<std::uint32_t>{1, 3}));
}

TEST(LightTable, UnlitPatchesListTheDarkLight) {
  const LightTable table = make_light_table(*square_with({{.position = {0, 0, 9}, .range = 1.0F}}, false));
  EXPECT_EQ(listed(table, table.of_patch.at(0)), std::vector<std::uint32_t>{0});
  EXPECT_EQ(red_of(table.lights.at(0)), 0.0F);
  EXPECT_FALSE(make_light_table(*square_with({}, false)).used());
}

}  // namespace
}  // namespace atlaswire::render
