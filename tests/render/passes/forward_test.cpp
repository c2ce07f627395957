#include "render/passes/forward.h"

#include "tests/render/gpu/gpu_fixture.h"
#include "tests/render/passes/picture_checks.h"
#include "tests/render/passes/scene_builder.h"

#include <numbers>

namespace atlaswire::render {
namespace {

using test::displayed;
using test::expect_pixel;
using test::glowing;
using test::SceneBuilder;

class ForwardTest : public test::GpuTest {
 protected:
  static Picture render(const std::shared_ptr<const Scene>& scene, const Camera& camera) {
    const SceneGpu gpu(device(), scene);
    return ForwardPass(device(), gpu).render(camera);
  }
  /// Looks along -Z from (0, 0, z).
  static Camera camera_at(double z) {
    return {.pose = {.position = {0, 0, z}}, .vertical_fov = std::numbers::pi / 2, .extent = {64, 64}};
  }
};

/// Covers the camera's whole view from z = 0, facing it.
void wall(SceneBuilder& builder, std::uint16_t material, float z = 0.0F) {
  builder.rectangle(material, {-10, -10, z}, {20, 0, 0}, {0, 20, 0});
}

TEST_F(ForwardTest, EmissionIsToneMappedAndEncoded) {
  SceneBuilder builder;
  builder.scene.exposure = 1.0F;
  wall(builder, builder.material(glowing({0.5F, 0.05F, 2.0F})));
  expect_pixel(render(builder.build(), camera_at(2)), 20, 40, displayed({0.5F, 0.05F, 2.0F}), 1);
}

TEST_F(ForwardTest, EmptyPixelsShowTheBackgroundAndHaveNoCoverage) {
  SceneBuilder builder;
  builder.scene.background = {0.2F, 0.4F, 0.6F};
  builder.rectangle(builder.material(glowing({1, 1, 1})), {0, -10, 0}, {10, 0, 0}, {0, 20, 0});
  const Picture picture = render(builder.build(), camera_at(2));
  expect_pixel(picture, 10, 32, displayed({0.2F, 0.4F, 0.6F}, 0), 1);
  expect_pixel(picture, 50, 32, displayed({1, 1, 1}), 1);
}

TEST_F(ForwardTest, SceneWithoutAnyPatchIsBackground) {
  SceneBuilder builder;
  expect_pixel(render(builder.build(), camera_at(2)), 32, 32, {0, 0, 0, 0}, 0);
}

// Light, viewer and normal on one line: D = 1/pi at roughness 1, V = 1/4, F = 0.04.
TEST_F(ForwardTest, PointLightOnTheAxisMatchesTheClosedForm) {
  SceneBuilder builder;
  builder.scene.lights.push_back({.position = {0, 0, 2}, .range = 8.0F, .color = {12, 6, 3}});
  wall(builder, builder.material({.base_color = {0.8F, 0.6F, 0.4F, 1.0F}}));
  Camera camera = camera_at(4);
  camera.extent = {65, 65};
  const float window = 1.0F - std::pow(2.0F / 8.0F, 4.0F);
  const glm::vec3 albedo{0.8F, 0.6F, 0.4F};
  const glm::vec3 brdf = (0.96F * albedo + glm::vec3{0.04F * 0.25F}) / std::numbers::pi_v<float>;
  const glm::vec3 expected = brdf * glm::vec3{12, 6, 3} / 4.0F * window;
  expect_pixel(render(builder.build(), camera), 32, 32, displayed(expected), 1);
}

TEST_F(ForwardTest, LightEndsAtItsRange) {
  SceneBuilder builder;
  builder.scene.lights.push_back({.position = {0, 0, 2}, .range = 1.9F, .color = {1000, 1000, 1000}});
  wall(builder, builder.material({}));
  expect_pixel(render(builder.build(), camera_at(4)), 32, 32, {0, 0, 0, 255}, 0);
}

TEST_F(ForwardTest, SpotLightEndsAtItsCone) {
  SceneBuilder builder;
  builder.scene.lights.push_back({.position = {0, 0, 2},
                                  .range = 50.0F,
                                  .color = {10, 10, 10},
                                  .cos_outer = std::cos(0.3F),
                                  .direction = {0, 0, -1},
                                  .cos_inner = std::cos(0.2F)});
  wall(builder, builder.material({}));
  const Picture picture = render(builder.build(), camera_at(4));
  EXPECT_GT(picture.at(32, 32)[0], 100);
  // 0.3 rad from 2 m away is 0.62 m; a pixel is 1/8 m.
  EXPECT_GT(picture.at(32 + 3, 32)[0], 60);
  EXPECT_EQ(picture.at(32 + 6, 32)[0], 0);
}

TEST_F(ForwardTest, SunLightsWhatNothingShades) {
  SceneBuilder builder;
  builder.scene.sun = {.direction = glm::normalize(glm::vec3{0, -1, -1}), .color = {3, 3, 3}};
  const std::uint16_t wall_material = builder.material({});
  wall(builder, wall_material);
  // A roof that reaches 1 m towards the viewer at height 1: shades the wall from 1 down to 0.
  builder.rectangle(wall_material, {-10, 1, 1}, {20, 0, 0}, {0, 0, -1});
  const Picture picture = render(builder.build(), camera_at(4));
  // Rows are 1/8 m; height 0 is row 32.
  const float n_dot_l = std::sqrt(0.5F);
  const int lit = picture.at(32, 44)[0];
  EXPECT_NEAR(lit, displayed(glm::vec3{0.96F * 3 * n_dot_l / std::numbers::pi_v<float>})[0], 6);
  EXPECT_EQ(picture.at(32, 28)[0], 0) << "in the roof's shadow";
  EXPECT_GT(picture.at(32, 10)[0], 100) << "above the roof";
}

TEST_F(ForwardTest, FlatGroundDoesNotShadeItself) {
  SceneBuilder builder;
  builder.scene.sun = {.direction = glm::normalize(glm::vec3{0.9F, -0.3F, -0.2F}), .color = {3, 3, 3}};
  builder.rectangle(builder.material({}), {-10, -1, 10}, {20, 0, 0}, {0, 0, -20});
  const Picture picture = render(builder.build(), camera_at(8));
  int darkest = 255;
  for (std::uint32_t y = 44; y < 64; ++y) {
    for (std::uint32_t x = 4; x < 60; ++x) darkest = std::min(darkest, int{picture.at(x, y)[0]});
  }
  EXPECT_GT(darkest, 100);
}

TEST_F(ForwardTest, BackFacesAreCulledUnlessDoubleSided) {
  for (const bool double_sided : {false, true}) {
    SceneBuilder builder;
    Material material = glowing({1, 1, 1});
    material.draw.double_sided = double_sided;
    builder.rectangle(builder.material(material), {10, -10, 0}, {-20, 0, 0}, {0, 20, 0});
    const Picture picture = render(builder.build(), camera_at(2));
    EXPECT_EQ(picture.at(32, 32)[3], double_sided ? 255 : 0);
  }
}

TEST_F(ForwardTest, DoubleSidedSurfacesAreLitOnTheSideSeen) {
  SceneBuilder builder;
  builder.scene.lights.push_back({.position = {0, 0, 2}, .range = 50.0F, .color = {20, 20, 20}});
  Material material;
  material.draw.double_sided = true;
  const std::uint16_t m = builder.material(material);
  builder.rectangle(m, {0, -10, 0}, {-10, 0, 0}, {0, 20, 0});  // its back to light and viewer
  builder.rectangle(m, {0, -10, 0}, {10, 0, 0}, {0, 20, 0});
  const Picture picture = render(builder.build(), camera_at(2));
  EXPECT_GT(picture.at(40, 32)[0], 50);
  EXPECT_NEAR(picture.at(23, 32)[0], picture.at(40, 32)[0], 2);
}

TEST_F(ForwardTest, MasksCutHolesAndBlendsMix) {
  SceneBuilder builder;
  const std::int32_t halves = builder.texture(
      {.name = "halves", .extent = {2, 1}, .rgba = {255, 255, 255, 255, 255, 255, 255, 0}, .nearest = true});
  wall(builder, builder.material(glowing({0, 0, 1})), -1.0F);
  Material mask = glowing({1, 0, 0});
  mask.base_color_texture = halves;
  mask.draw.alpha = PatchClass::Alpha::kMask;
  const std::uint16_t masked = builder.material(mask);
  builder.rectangle(masked, {-2, -2, 0}, {4, 0, 0}, {0, 4, 0});
  Material glass = glowing({0, 1, 0});
  glass.base_color.a = 0.25F;
  glass.draw.alpha = PatchClass::Alpha::kBlend;
  builder.rectangle(builder.material(glass), {-2, 0, 0.5F}, {4, 0, 0}, {0, 4, 0});
  const Picture picture = render(builder.build(), camera_at(2));
  const Rgba8 red = displayed({1, 0, 0});
  const Rgba8 green = displayed({0, 1, 0});
  const Rgba8 blue = displayed({0, 0, 1});
  expect_pixel(picture, 16, 48, red, 1);
  expect_pixel(picture, 48, 48, blue, 1);
  const auto mixed = [&](const Rgba8& behind) {
    Rgba8 c{0, 0, 0, 255};
    for (std::size_t i = 0; i < 3; ++i) {
      c[i] = static_cast<std::uint8_t>(std::lround(0.25 * green[i] + 0.75 * behind[i]));
    }
    return c;
  };
  expect_pixel(picture, 16, 16, mixed(red), 2);
  expect_pixel(picture, 48, 16, mixed(blue), 2);
}

TEST_F(ForwardTest, BlendedPatchesAreDrawnFarToNear) {
  SceneBuilder builder;
  std::array<std::uint16_t, 2> glass{};
  for (std::size_t i = 0; i < 2; ++i) {
    Material m = glowing(i == 0 ? glm::vec3{1, 0, 0} : glm::vec3{0, 1, 0});
    m.base_color.a = 0.5F;
    m.draw.alpha = PatchClass::Alpha::kBlend;
    glass[i] = builder.material(m);
  }
  wall(builder, glass[0], 1.0F);  // red in front, though its material comes first
  wall(builder, glass[1], 0.0F);
  const Picture picture = render(builder.build(), camera_at(3));
  const Rgba8 full = displayed({1, 0, 0});
  expect_pixel(picture, 32, 32,
               {static_cast<std::uint8_t>(full[0] / 2), static_cast<std::uint8_t>(full[0] / 4), 0, 191}, 3);
}

TEST_F(ForwardTest, SceneFarFromItsOriginLooksTheSame) {
  const auto make = [](const glm::dvec3& origin) {
    SceneBuilder builder;
    builder.scene.origin = origin;
    builder.scene.lights.push_back({.position = {0.3F, 0.2F, 1}, .range = 8.0F, .color = {4, 3, 2}});
    wall(builder, builder.material({.roughness = 0.4F}));
    return builder.build();
  };
  const glm::dvec3 far{1e6, -2e6, 3e6};
  Camera camera = camera_at(2);
  const Picture near_picture = render(make({0, 0, 0}), camera);
  camera.pose.position += far;
  EXPECT_EQ(render(make(far), camera), near_picture);
}

TEST_F(ForwardTest, GeometryAroundAndBehindTheCameraIsHarmless) {
  SceneBuilder builder;
  const std::uint16_t m = builder.material(glowing({1, 1, 1}));
  // The floor crosses the plane of the camera and goes on behind it.
  builder.rectangle(m, {-50, -0.2F, 50}, {100, 0, 0}, {0, 0, -100});
  const Picture picture = render(builder.build(), camera_at(0));
  EXPECT_EQ(picture.at(32, 60)[3], 255);
  EXPECT_EQ(picture.at(32, 4)[3], 0);
}

TEST_F(ForwardTest, NormalMapsBendTheLight) {
  const auto brightness = [](std::uint8_t red) {
    SceneBuilder builder;
    builder.scene.sun = {.direction = glm::normalize(glm::vec3{-1, 0, -1}), .color = {2, 2, 2}};
    Material m;
    m.normal_texture =
        builder.texture({.name = "normals", .extent = {1, 1}, .rgba = {red, 128, 218, 255}, .srgb = false});
    wall(builder, builder.material(m));
    return render(builder.build(), camera_at(2)).at(32, 32)[0];
  };
  // The sun stands at +X: a normal bent towards +X (the tangent) meets it head on.
  EXPECT_GT(brightness(218), brightness(128) + 10);
  EXPECT_LT(brightness(38), brightness(128) - 40);
}

}  // namespace
}  // namespace atlaswire::render
