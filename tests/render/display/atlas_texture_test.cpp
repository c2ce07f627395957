#include "render/display/atlas_texture.h"

#include "base/program.h"
#include "base/random.h"
#include "render/display/display_pass.h"
#include "tests/render/gpu/gpu_fixture.h"

#include <numbers>

namespace atlaswire::render {
namespace {

/// Random planes whose rows lie `padding` octets apart.
struct Planes {
  Planes(Extent2D size, std::uint32_t padding, std::uint64_t seed)
      : extent(size), stride(size.width + padding) {
    Random random(seed);
    const auto fill = [&](std::vector<std::uint8_t>& plane, std::uint32_t width, std::uint32_t height,
                          std::uint32_t row) {
      plane.assign(std::size_t{row} * height, 255);
      for (std::uint32_t i = 0; i < width * height; ++i) {
        plane[std::size_t{i / width} * row + i % width] = static_cast<std::uint8_t>(random.below(256));
      }
    };
    fill(y, extent.width, extent.height, stride);
    fill(u, extent.width / 2, extent.height / 2, stride / 2);
    fill(v, extent.width / 2, extent.height / 2, stride / 2);
  }
  [[nodiscard]] I420Planes view() const { return {extent, y.data(), u.data(), v.data(), stride, stride / 2}; }

  Extent2D extent;
  std::uint32_t stride;
  std::vector<std::uint8_t> y;
  std::vector<std::uint8_t> u;
  std::vector<std::uint8_t> v;
};

class AtlasTextureTest : public test::GpuTest {
 protected:
  /// The 16 x 16 atlas's inner 15 x 15 texels over a whole picture.
  static Picture show(const AtlasTexture& atlas, std::uint32_t slot) {
    DisplayPatch square{2, {}, Block{0, 0, 4, 4}, {}};
    square.positions = {glm::vec3{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 0}};
    MeshData data;
    build_mesh(std::array{square}, data);
    DisplayMesh mesh(device());
    mesh.assign(data, {0, 0, 0});
    DisplayPass pass(device(), atlas, {0, 0, 0});
    pass.draw(mesh, slot,
              {.pose = {.position = {0, 0, 1}}, .vertical_fov = std::numbers::pi / 2, .extent = {64, 64}});
    return pass.read_back();
  }
};

TEST_F(AtlasTextureTest, RowPaddingIsNoPartOfThePicture) {
  AtlasTexture atlas(device(), {16, 16}, false);
  const std::uint32_t tight = atlas.upload(Planes({16, 16}, 0, 1).view());
  const std::uint32_t padded = atlas.upload(Planes({16, 16}, 48, 1).view());
  const std::uint32_t other = atlas.upload(Planes({16, 16}, 48, 2).view());
  EXPECT_EQ(show(atlas, tight), show(atlas, padded));
  EXPECT_NE(show(atlas, tight), show(atlas, other));
}

TEST_F(AtlasTextureTest, APictureStaysWhileTheNextOnesArrive) {
  AtlasTexture atlas(device(), {16, 16}, true, 3);
  EXPECT_EQ(atlas.picture_extent(), (Extent2D{16, 32}));
  const std::uint32_t first = atlas.upload(Planes({16, 32}, 0, 1).view());
  const Picture before = show(atlas, first);
  for (std::uint64_t seed = 2; seed <= 3; ++seed)
    EXPECT_NE(atlas.upload(Planes({16, 32}, 0, seed).view()), first);
  EXPECT_EQ(show(atlas, first), before);
  EXPECT_EQ(atlas.upload(Planes({16, 32}, 0, 4).view()), first);
  EXPECT_NE(show(atlas, first), before);
}

TEST_F(AtlasTextureTest, GreyIsGreyAndExtremesSaturate) {
  AtlasTexture atlas(device(), {16, 16}, false);
  Planes planes({16, 16}, 0, 1);
  const auto center = [&](std::uint8_t y, std::uint8_t u, std::uint8_t v) {
    std::ranges::fill(planes.y, y);
    std::ranges::fill(planes.u, u);
    std::ranges::fill(planes.v, v);
    return show(atlas, atlas.upload(planes.view())).at(32, 32);
  };
  EXPECT_EQ(center(77, 128, 128), (Rgba8{77, 77, 77, 255}));
  EXPECT_EQ(center(255, 255, 255)[2], 255);
  EXPECT_EQ(center(0, 0, 0), (Rgba8{0, 84, 0, 255}));
}

TEST_F(AtlasTextureTest, RefusesSidesThatDoNotPack) {
  EXPECT_THROW((AtlasTexture{device(), {20, 16}, false}), ProgramError);
  EXPECT_THROW((AtlasTexture{device(), {16, 15}, false}), ProgramError);
}

}  // namespace
}  // namespace atlaswire::render
