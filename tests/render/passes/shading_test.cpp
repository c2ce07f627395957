#include "render/passes/shading.h"

#include "base/random.h"
#include "tests/render/gpu/gpu_fixture.h"
#include "tests/render/passes/picture_checks.h"
#include "tests/render/passes/scene_builder.h"

namespace atlaswire::render {
namespace {

using test::displayed;
using test::expect_pixel;
using test::SceneBuilder;

constexpr Rgba8 kUnused{128, 128, 128, 0};

class ShadingTest : public test::GpuTest {
 protected:
  static Picture shade(const std::shared_ptr<const Scene>& scene, Extent2D atlas,
                       std::span<const PlacedPatch> patches) {
    const SceneGpu gpu(device(), scene);
    ShadingPass pass(device(), gpu, atlas, 2);
    SubmitContext context(device(), "shading test");
    context.run([&](const vk::raii::CommandBuffer& commands) {
      pass.record(commands, patches, scene->start.position, true);
    });
    return test::read_image(device(), pass.atlas());
  }
};

/// The corners of a patch laid out as its block is, on the plane z = 0.
std::vector<glm::vec3> flat_corners(std::uint32_t triangles) {
  std::vector<glm::vec3> corners;
  for (std::uint32_t c = 0; c < corner_count(triangles); ++c) {
    const auto [u, v] = corner_coordinate(triangles, c);
    corners.emplace_back(u, v, 0.0F);
  }
  return corners;
}

/// Places blocks of all sizes in rows without gaps: every patch has eager neighbours.
struct Shelves {
  explicit Shelves(std::uint32_t atlas_width) : width(atlas_width) {}
  Block place(std::uint8_t w, std::uint8_t h, bool transposed) {
    if (x + (1U << w) > width) {
      x = 0;
      y += row;
      row = 0;
    }
    const Block block{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), w, h, transposed};
    x += block.width();
    row = std::max(row, block.height());
    return block;
  }
  std::uint32_t width;
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t row = 0;
};

TEST_F(ShadingTest, FillsEveryTexelOfItsBlockAndNoOther) {
  SceneBuilder builder;
  const std::array<glm::vec3, 3> colors{glm::vec3{1, 0, 0}, glm::vec3{0, 1, 0}, glm::vec3{0, 0, 1}};
  std::array<std::uint16_t, 3> materials{};
  for (std::size_t i = 0; i < 3; ++i) materials[i] = builder.material(test::glowing(colors[i]));
  // The builder sorts by material, so ids follow material, then order.
  std::vector<std::vector<Block>> blocks(3);
  Shelves shelves(256);
  std::size_t turn = 0;
  for (int repeat = 0; repeat < 2; ++repeat) {
    for (std::uint8_t h = 0; h <= 5; ++h) {
      for (std::uint8_t w = h; w <= 6; ++w) {
        for (std::uint32_t triangles = 1; triangles <= 3; ++triangles) {
          const std::size_t color = turn++ % 3;
          const auto corners = flat_corners(triangles);
          builder.patch(materials[color], corners, std::vector<glm::vec2>(corners.size()));
          blocks[color].push_back(shelves.place(w, h, repeat == 1));
        }
      }
    }
  }
  std::vector<PlacedPatch> placed;
  for (const auto& list : blocks) {
    for (const Block& block : list) placed.push_back({static_cast<PatchId>(placed.size()), block});
  }
  const Extent2D atlas{256, shelves.y + shelves.row + 2};
  Picture expected(atlas, kUnused);
  for (std::size_t color = 0; color < 3; ++color) {
    for (const Block& b : blocks[color]) {
      for (std::uint32_t i = 0; i < b.area(); ++i) {
        expected.set(b.x + i % b.width(), b.y + i / b.width(), displayed(colors[color]));
      }
    }
  }
  const Picture picture = shade(builder.build(), atlas, placed);
  for (std::uint32_t y = 0; y < atlas.height; ++y) {
    for (std::uint32_t x = 0; x < atlas.width; ++x) {
      ASSERT_LE(test::difference(picture.at(x, y), expected.at(x, y)), 1) << x << "," << y;
    }
  }
}

/// Mild noise, a texel for each of the block's.
Texture noise_texture(Extent2D extent) {
  Random random(extent.width * 100 + extent.height);
  Texture texture{.name = "noise", .extent = extent, .srgb = false, .repeat_u = false, .repeat_v = false};
  for (std::uint64_t i = 0; i < extent.area() * 4; ++i) {
    texture.rgba.push_back(static_cast<std::uint8_t>(100 + random.below(60)));
  }
  return texture;
}

// A texture with a texel for each of the block's texels must come back as it is: attributes are exact at
// texel centres, also beyond the longest side of a single triangle and when the layout is transposed.
TEST_F(ShadingTest, AttributesAreExactAtTexelCentres) {
  for (std::uint32_t triangles = 1; triangles <= 3; ++triangles) {
    for (const bool transposed : {false, true}) {
      for (const auto& [w, h] : {std::pair{1, 1}, {3, 3}, {5, 2}, {6, 4}}) {
        const Block block{8, 4, static_cast<std::uint8_t>(w), static_cast<std::uint8_t>(h), transposed};
        Extent2D side{block.width(), block.height()};
        if (transposed) std::swap(side.width, side.height);
        SceneBuilder builder;
        Material material = test::glowing({1, 1, 1});
        material.emissive_texture = builder.texture(noise_texture(side));
        const auto corners = flat_corners(triangles);
        std::vector<glm::vec2> uvs;
        for (const glm::vec3& c : corners) {
          uvs.emplace_back(
              (0.5F + c.x * static_cast<float>(side.width - 1)) / static_cast<float>(side.width),
              (0.5F + c.y * static_cast<float>(side.height - 1)) / static_cast<float>(side.height));
        }
        builder.patch(builder.material(material), corners, uvs);
        const auto scene = builder.build();
        const Picture picture = shade(scene, {128, 72}, std::array{PlacedPatch{PatchId{0}, block}});
        for (std::uint32_t i = 0; i < block.area(); ++i) {
          const std::uint32_t x = i % block.width();
          const std::uint32_t y = i / block.width();
          const std::uint32_t texel = transposed ? x * side.width + y : y * side.width + x;
          const std::uint8_t* t = &scene->textures[0].rgba[std::size_t{4} * texel];
          const glm::vec3 radiance = glm::vec3{t[0], t[1], t[2]} / 255.0F;
          SCOPED_TRACE(::testing::Message() << triangles << " triangles, " << block.width() << "x"
                                            << block.height() << (transposed ? " transposed" : ""));
          expect_pixel(picture, block.x + x, block.y + y, displayed(radiance), 3);
        }
      }
    }
  }
}

TEST_F(ShadingTest, OneTexelIsTheMiddleOfItsPatch) {
  SceneBuilder builder;
  Material material = test::glowing({1, 1, 1});
  material.emissive_texture = builder.texture(
      {.name = "ends", .extent = {2, 1}, .rgba = {0, 0, 0, 255, 200, 200, 200, 255}, .srgb = false});
  const auto corners = flat_corners(2);
  builder.patch(
      builder.material(material), corners,
      std::array{glm::vec2{0.25F, 0}, glm::vec2{0.75F, 0}, glm::vec2{0.75F, 1}, glm::vec2{0.25F, 1}});
  const Picture picture =
      shade(builder.build(), {8, 8}, std::array{PlacedPatch{PatchId{0}, Block{4, 2, 0, 0}}});
  expect_pixel(picture, 4, 2, displayed(glm::vec3{100.0F / 255.0F}), 3);
}

TEST_F(ShadingTest, MaskedCoverageIsOneHalfAtTheCutoff) {
  const auto coverage = [](std::uint8_t alpha, float cutoff) {
    SceneBuilder builder;
    Material material = test::glowing({1, 1, 1});
    material.draw.alpha = PatchClass::Alpha::kMask;
    material.alpha_cutoff = cutoff;
    material.base_color_texture =
        builder.texture({.name = "alpha", .extent = {1, 1}, .rgba = {255, 255, 255, alpha}});
    const auto corners = flat_corners(2);
    builder.patch(builder.material(material), corners, std::vector<glm::vec2>(4));
    return shade(builder.build(), {8, 8}, std::array{PlacedPatch{PatchId{0}, Block{0, 0, 2, 2}}}).at(1, 1)[3];
  };
  EXPECT_NEAR(coverage(51, 0.2F), 128, 1);
  EXPECT_NEAR(coverage(204, 0.8F), 128, 1);
  EXPECT_EQ(coverage(255, 0.8F), 255);
  EXPECT_EQ(coverage(0, 0.2F), 0);
}

TEST_F(ShadingTest, BlocksThatAreNotShadedAgainStay) {
  SceneBuilder builder;
  const std::uint16_t material = builder.material({.base_color = {1, 1, 1, 1}});
  builder.scene.lights.push_back({.position = {0.5F, 0.5F, 1}, .range = 9, .color = {1, 1, 1}});
  builder.scene.start.position = {0.5, 0.5, 1};
  for (int i = 0; i < 2; ++i) builder.patch(material, flat_corners(2), std::vector<glm::vec2>(4));
  const auto scene = builder.build();
  const SceneGpu gpu(device(), scene);
  ShadingPass pass(device(), gpu, {64, 32}, 2);
  SubmitContext context(device(), "shading test");
  const std::array both{PlacedPatch{PatchId{0}, Block{0, 0, 5, 5}},
                        PlacedPatch{PatchId{1}, Block{32, 0, 5, 5}}};
  const auto record = [&](std::span<const PlacedPatch> patches, const glm::dvec3& eye, bool clear) {
    std::uint64_t texels = 0;
    context.run([&](const vk::raii::CommandBuffer& commands) {
      texels = pass.record(commands, patches, eye, clear);
    });
    return texels;
  };
  EXPECT_EQ(record(both, {0.5, 0.5, 1}, true), 2048U);
  const Picture before = test::read_image(device(), pass.atlas());
  EXPECT_EQ(record(std::span(both).subspan(1), {0.5, 0.5, 1}, false), 1024U);
  EXPECT_EQ(test::read_image(device(), pass.atlas()), before);
  EXPECT_EQ(record({}, {0.5, 0.5, 1}, true), 0U);
  EXPECT_EQ(test::read_image(device(), pass.atlas()), Picture({64, 32}, kUnused));
}

}  // namespace
}  // namespace atlaswire::render
