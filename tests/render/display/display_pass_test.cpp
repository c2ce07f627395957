#include "render/display/display_pass.h"

#include "base/random.h"
#include "render/image/metrics.h"
#include "tests/render/display/round_trip.h"
#include "tests/render/gpu/gpu_fixture.h"
#include "tests/render/passes/picture_checks.h"
#include "tests/render/passes/scene_builder.h"

#include <numbers>

namespace atlaswire::render {
namespace {

using test::displayed;
using test::expect_pixel;
using test::glowing;
using test::RoundTrip;
using test::SceneBuilder;

class DisplayPassTest : public test::GpuTest {
 protected:
  static Camera camera_at(const glm::dvec3& position, Extent2D extent = {128, 128}) {
    return {.pose = {.position = position}, .vertical_fov = std::numbers::pi / 2, .extent = extent};
  }
};

/// A square of n x n rectangles from (-1,-1) to (1,1) at z = 0, each with its own material.
void add_board(SceneBuilder& builder, std::uint32_t n,
               const std::function<std::uint16_t(std::uint32_t)>& material) {
  const float side = 2.0F / static_cast<float>(n);
  for (std::uint32_t i = 0; i < n * n; ++i) {
    const glm::vec3 corner{-1.0F + side * static_cast<float>(i % n), -1.0F + side * static_cast<float>(i / n),
                           0};
    builder.rectangle(material(i), corner, {side, 0, 0}, {0, side, 0});
  }
}

/// Patches in their order, in equal blocks side by side.
std::vector<PlacedPatch> tiled(std::size_t count, std::uint8_t log2, std::uint32_t atlas_width) {
  std::vector<PlacedPatch> placed;
  const std::uint32_t columns = atlas_width >> log2;
  for (std::uint32_t i = 0; i < count; ++i) {
    placed.push_back(
        {static_cast<PatchId>(i), Block{static_cast<std::uint16_t>((i % columns) << log2),
                                        static_cast<std::uint16_t>((i / columns) << log2), log2, log2}});
  }
  return placed;
}

/// Soft stripes and rings of grey: detail that half-resolution chroma cannot spoil.
Texture grey_pattern(std::uint32_t side) {
  Texture texture{.name = "pattern", .extent = {side, side}, .srgb = true};
  for (std::uint32_t i = 0; i < side * side; ++i) {
    const double x = i % side;
    const double y = i / side;
    const double v =
        128 + 60 * std::sin(x * 0.15) * std::cos(y * 0.11) + 50 * std::sin(std::hypot(x, y) * 0.07);
    const auto grey = static_cast<std::uint8_t>(v);
    texture.rgba.insert(texture.rgba.end(), {grey, grey, grey, 255});
  }
  return texture;
}

TEST_F(DisplayPassTest, TexturedAndLitBoardLooksLikeTheGroundTruth) {
  SceneBuilder builder;
  builder.scene.ambient_up = builder.scene.ambient_down = glm::vec3{0.3F};
  builder.scene.lights.push_back({.position = {0.4F, 0.3F, 0.7F}, .range = 9, .color = {2, 2, 2}});
  Material material{.roughness = 0.5F};
  material.base_color_texture = builder.texture(grey_pattern(256));
  const std::uint16_t m = builder.material(material);
  add_board(builder, 4, [&](std::uint32_t) { return m; });
  RoundTrip trip(device(), builder.build(), {512, 512});
  Camera camera = camera_at({0.1, -0.2, 1.1}, {256, 256});
  camera.pose.orientation = glm::angleAxis(0.3, glm::normalize(glm::dvec3{1, 2, 0}));
  const Picture shown = trip.display(tiled(16, 7, 512), camera);
  const Picture truth = trip.forward(camera);
  EXPECT_GT(psnr(truth, shown), 38.0);
  EXPECT_GT(mssim(truth, shown), 0.98);
}

// Neighbours in the atlas in the hardest contrast; on screen each patch must be wholly its own colour.
TEST_F(DisplayPassTest, NoColourReachesANeighbour) {
  for (const std::uint8_t log2 : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{4}}) {
    SceneBuilder builder;
    const std::array<glm::vec3, 4> colors{glm::vec3{9, 0, 0}, glm::vec3{0, 9, 0}, glm::vec3{0, 0, 9},
                                          glm::vec3{9, 9, 9}};
    std::array<std::uint16_t, 4> materials{};
    for (std::size_t i = 0; i < 4; ++i) materials[i] = builder.material(glowing(colors[i]));
    std::vector<std::size_t> color_of(64);
    Random random(log2);
    add_board(builder, 8, [&](std::uint32_t i) {
      color_of[i] = random.below(4);
      return materials[color_of[i]];
    });
    const auto scene = builder.build();
    // Patches were sorted by material: walk the atlas in an order that mixes them.
    std::vector<PlacedPatch> placed = tiled(64, log2, 8U << log2);
    for (std::uint32_t i = 0; i < 64; ++i) placed[i].block = tiled(64, log2, 8U << log2)[(i * 29) % 64].block;
    RoundTrip trip(device(), scene, {std::max(8U << log2, 16U), 8U << log2});
    const Picture shown = trip.display(placed, camera_at({0, 0, 1}));
    for (std::uint32_t y = 0; y < 128; ++y) {
      for (std::uint32_t x = 0; x < 128; ++x) {
        const std::uint32_t cell = (127 - y) / 16 * 8 + x / 16;
        ASSERT_LE(test::difference(shown.at(x, y), displayed(colors[color_of[cell]])), 3) << x << "," << y;
      }
    }
  }
}

// A lone triangle's longest side: what lies beyond it in the block must not show.
TEST_F(DisplayPassTest, LongestSideOfALoneTriangleIsClean) {
  SceneBuilder builder;
  Material material = glowing({1, 1, 1});
  Texture ramp{.name = "ramp", .extent = {64, 1}, .srgb = false, .repeat_u = false};
  for (std::uint32_t i = 0; i < 64; ++i) {
    const auto v = static_cast<std::uint8_t>(40 + 2 * i);
    ramp.rgba.insert(ramp.rgba.end(), {v, v, v, 255});
  }
  material.emissive_texture = builder.texture(ramp);
  const std::array corners{glm::vec3{-1, -1, 0}, glm::vec3{1, -1, 0}, glm::vec3{-1, 1, 0}};
  builder.patch(builder.material(material), corners,
                std::array{glm::vec2{0.1F, 0.5F}, glm::vec2{0.45F, 0.5F}, glm::vec2{0.45F, 0.5F}});
  RoundTrip trip(device(), builder.build(), {64, 64});
  const Camera camera = camera_at({0, 0, 1});
  for (const std::uint8_t log2 : {std::uint8_t{2}, std::uint8_t{5}}) {
    const Picture shown = trip.display({{PatchId{0}, Block{16, 16, log2, log2}}}, camera);
    const Picture truth = trip.forward(camera);
    for (std::uint32_t i = 4; i < 124; ++i) {
      for (std::uint32_t inside = 1; inside <= 3; ++inside) {
        // Row 0 is the top: the longest side runs from the top left to the bottom right.
        ASSERT_LE(test::difference(shown.at(i - inside, i), truth.at(i - inside, i)), 3) << i;
      }
    }
  }
}

TEST_F(DisplayPassTest, PatchesOfOneTwoAndThreeTrianglesMatchTheGroundTruth) {
  for (std::uint32_t triangles = 1; triangles <= 3; ++triangles) {
    for (const bool transposed : {false, true}) {
      SceneBuilder builder;
      builder.scene.ambient_up = builder.scene.ambient_down = glm::vec3{0.4F};
      Material material;
      material.base_color_texture = builder.texture(grey_pattern(64));
      std::vector<glm::vec3> corners;
      std::vector<glm::vec2> uvs;
      for (std::uint32_t c = 0; c < corner_count(triangles); ++c) {
        const auto [u, v] = corner_coordinate(triangles, c);
        // No rectangle: sides of all directions.
        corners.emplace_back(2 * u - 1 + 0.2F * v, 2 * v - 1 - 0.3F * u * v, 0.1F * u);
        uvs.emplace_back(u, v);
      }
      builder.patch(builder.material(material), corners, uvs);
      RoundTrip trip(device(), builder.build(), {128, 128});
      const Camera camera = camera_at({0, 0, 1.3});
      const Picture shown = trip.display({{PatchId{0}, Block{0, 0, 7, 7, transposed}}}, camera);
      const Picture truth = trip.forward(camera);
      EXPECT_GT(psnr(truth, shown), 36.0) << triangles << (transposed ? " transposed" : "");
      EXPECT_GT(mssim(truth, shown), 0.98);
    }
  }
}

TEST_F(DisplayPassTest, MaskedHolesAndBlendedGlassMatchTheGroundTruth) {
  SceneBuilder builder;
  builder.scene.background = {0.1F, 0.1F, 0.1F};
  Texture disc{.name = "disc", .extent = {64, 64}, .srgb = true};
  for (std::uint32_t i = 0; i < 64 * 64; ++i) {
    const double r = std::hypot(i % 64 - 31.5, static_cast<double>(i / 64) - 31.5);
    const double alpha = std::clamp(0.5 + (20 - r) * 0.1, 0.0, 1.0);
    disc.rgba.insert(disc.rgba.end(), {200, 200, 200, static_cast<std::uint8_t>(std::lround(alpha * 255))});
  }
  builder.scene.ambient_up = builder.scene.ambient_down = glm::vec3{0.5F};
  Material mask;
  mask.draw = {PatchClass::Alpha::kMask, true};
  mask.base_color_texture = builder.texture(disc);
  mask.alpha_cutoff = 0.3F;
  builder.rectangle(builder.material(mask), {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  Material glass = glowing({0.5F, 0.5F, 0.5F});
  glass.base_color.a = 0.4F;
  glass.draw.alpha = PatchClass::Alpha::kBlend;
  builder.rectangle(builder.material(glass), {-0.5F, -1, 0.2F}, {0.6F, 0, 0}, {0, 2, 0});
  RoundTrip trip(device(), builder.build(), {256, 128});
  const Camera camera = camera_at({0, 0, 1.2});
  const Picture shown =
      trip.display({{PatchId{0}, Block{0, 0, 7, 7}}, {PatchId{1}, Block{128, 0, 4, 4}}}, camera);
  const Picture truth = trip.forward(camera);
  EXPECT_GT(psnr(truth, shown), 34.0);
  EXPECT_GT(mssim(truth, shown), 0.97);
  expect_pixel(shown, 4, 4, displayed({0.1F, 0.1F, 0.1F}, 0), 1);
  EXPECT_EQ(shown.at(100, 64)[3], 255);
}

TEST_F(DisplayPassTest, FarFromTheOriginNothingTrembles) {
  const auto show = [](const glm::dvec3& origin) {
    SceneBuilder builder;
    builder.scene.origin = origin;
    const std::array materials{builder.material(glowing({1, 0, 0})), builder.material(glowing({0, 1, 0}))};
    add_board(builder, 8, [&](std::uint32_t i) { return materials[(i + i / 8) % 2]; });
    RoundTrip trip(device(), builder.build(), {128, 128});
    return trip.display(tiled(64, 4, 128), camera_at(origin + glm::dvec3{0.001, 0.002, 1}));
  };
  EXPECT_EQ(show({1e6, -3e6, 2e6}), show({0, 0, 0}));
}

TEST_F(DisplayPassTest, EmptyMeshShowsTheBackground) {
  SceneBuilder builder;
  builder.scene.background = {1, 0.5F, 0.25F};
  builder.rectangle(builder.material({}), {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  RoundTrip trip(device(), builder.build(), {64, 64});
  expect_pixel(trip.display({}, camera_at({0, 0, 1})), 64, 64, displayed({1, 0.5F, 0.25F}, 0), 1);
}

TEST_F(DisplayPassTest, BackFacesAndGeometryBehindTheCameraStayAway) {
  SceneBuilder builder;
  builder.rectangle(builder.material(glowing({1, 1, 1})), {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  RoundTrip trip(device(), builder.build(), {64, 64});
  Camera camera = camera_at({0, 0, -1});
  EXPECT_EQ(trip.display({{PatchId{0}, Block{0, 0, 4, 4}}}, camera).at(64, 64)[3], 0) << "behind";
  camera.pose.orientation = glm::angleAxis(std::numbers::pi, glm::dvec3{0, 1, 0});
  EXPECT_EQ(trip.display({{PatchId{0}, Block{0, 0, 4, 4}}}, camera).at(64, 64)[3], 0) << "its back";
}

}  // namespace
}  // namespace atlaswire::render
