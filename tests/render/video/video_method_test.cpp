#include "render/video/video_method.h"

#include "base/program.h"
#include "render/video/depth_plane.h"
#include "tests/render/gpu/gpu_fixture.h"
#include "tests/render/passes/scene_builder.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace atlaswire::render {
namespace {

using test::glowing;
using test::SceneBuilder;

/// A bright board 2 m before the origin that covers the right half of every row, a dark wall 8 m away, sky
/// above it.
std::shared_ptr<const Scene> board_and_wall() {
  SceneBuilder builder;
  builder.scene.background = {0.1F, 0.3F, 0.9F};
  builder.rectangle(builder.material(glowing({0.3F, 0.1F, 0.1F})), {-40, -40, -8}, {80, 0, 0}, {0, 42, 0});
  builder.rectangle(builder.material(glowing({2, 2, 0.5F})), {0.21F, -9, -2}, {9, 0, 0}, {0, 18, 0});
  return builder.build();
}

Camera camera_at(double z = 0) {
  return {.pose = {.position = {0, 0, z}}, .vertical_fov = std::numbers::pi / 2, .extent = {100, 60}};
}

MethodSettings settings(VideoDepth depth, double fov_scale = 1.2) {
  MethodSettings s;
  s.fov_scale = fov_scale;
  s.video = {.display = camera_at().extent, .depth = depth};
  return s;
}

class Video : public test::GpuTest {
 protected:
  static std::unique_ptr<Method> make(const MethodSettings& s) {
    return make_method("video", device(), board_and_wall(), s);
  }
};

TEST_F(Video, TheViewIsTheDisplaysWithAMarginOfWholePixels) {
  for (const double scale : {1.0, 1.1, 1.2, 1.5}) {
    const auto method = make(settings(VideoDepth::kNone, scale));
    const RenderedFrame frame = method->render({.frame = FrameId{7}, .camera = camera_at()});
    ASSERT_TRUE(frame.view.has_value());
    const Camera& view = frame.view->camera;
    EXPECT_EQ(frame.frame, FrameId{7});
    EXPECT_EQ(view.extent, method->picture_extent());
    EXPECT_EQ(view.extent, frame.picture.extent);
    EXPECT_EQ(view.extent.width % 8, 0U);
    EXPECT_GE(view.extent.width, 100 * scale - 1e-6);
    EXPECT_GE(view.extent.height, 60 * scale - 1e-6);
    EXPECT_EQ((view.extent.width - 100) % 2 + (view.extent.height - 60) % 2, 0U);
    EXPECT_NEAR(std::tan(view.vertical_fov / 2) / view.extent.height, 1.0 / 60, 1e-12);
  }
}

TEST_F(Video, MiddlePixelsAreThoseOfTheDisplaysOwnView) {
  const auto scene = board_and_wall();
  const SceneGpu gpu(device(), scene);
  const Picture truth = ForwardPass(device(), gpu).render(camera_at());
  const auto method = make(settings(VideoDepth::kNone));
  const I420Picture picture = method->render({.camera = camera_at()}).picture;
  const std::uint32_t left = (picture.extent.width - 100) / 2;
  const std::uint32_t top = (picture.extent.height - 60) / 2;
  for (std::uint32_t y = 0; y < 60; ++y) {
    for (std::uint32_t x = 0; x < 100; ++x) {
      const Rgba8 p = truth.at(x, y);
      const double luma = 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
      ASSERT_NEAR(picture.y[std::size_t{y + top} * picture.extent.width + x + left], luma, 1)
          << x << "," << y;
    }
  }
}

TEST_F(Video, FreeDepthIsTheDistanceAlongTheAxis) {
  const auto method = make(settings(VideoDepth::kFree));
  const RenderedFrame frame = method->render({.camera = camera_at(1)});
  const Extent2D extent = frame.view->camera.extent;
  EXPECT_EQ(frame.picture.extent, extent);
  ASSERT_EQ(frame.view->depth.size(), extent.area());
  const auto at = [&](std::uint32_t x, std::uint32_t y) {
    return frame.view->depth[std::size_t{y} * extent.width + x];
  };
  EXPECT_NEAR(at(4, extent.height / 2), 9, 1e-4);
  EXPECT_NEAR(at(extent.width - 4, extent.height / 2), 3, 1e-5);
  EXPECT_TRUE(std::isinf(at(4, 2)));
  EXPECT_NEAR(frame.view->nearest, 3, 1e-5);
  EXPECT_EQ(frame.change, nullptr);
}

TEST_F(Video, CodedDepthLiesBelowTheColours) {
  const auto exact_method = make(settings(VideoDepth::kFree));
  const auto coded_method = make(settings(VideoDepth::kCoded));
  const RenderedFrame exact = exact_method->render({.camera = camera_at(0.5)});
  const RenderedFrame coded = coded_method->render({.camera = camera_at(0.5)});
  const Extent2D extent = exact.picture.extent;
  const I420Picture& p = coded.picture;
  ASSERT_EQ(p.extent, (Extent2D{extent.width, extent.height * 2}));
  EXPECT_EQ(p.extent, coded_method->picture_extent());
  EXPECT_TRUE(coded.view->depth.empty());
  EXPECT_TRUE(std::equal(p.y, p.y + extent.area(), exact.picture.y));
  EXPECT_TRUE(std::equal(p.u, p.u + extent.area() / 4, exact.picture.u));
  EXPECT_TRUE(std::equal(p.v, p.v + extent.area() / 4, exact.picture.v));
  for (const std::uint8_t* chroma : {p.u, p.v}) {
    EXPECT_TRUE(std::all_of(chroma + extent.area() / 4, chroma + extent.area() / 2,
                            [](std::uint8_t c) { return c == 128; }));
  }
  const double nearest = coded.view->nearest;
  EXPECT_LE(nearest, exact.view->nearest);
  std::vector<float> decoded;
  decode_depth_plane({p.extent, p.y, p.u, p.v, p.extent.width, p.extent.width / 2}, nearest, decoded);
  ASSERT_EQ(decoded.size(), exact.view->depth.size());
  for (std::size_t i = 0; i < decoded.size(); ++i) {
    ASSERT_LE(std::abs(1 / decoded[i] - 1 / exact.view->depth[i]), 1.001 / (510 * nearest));
  }
}

TEST_F(Video, PicturesAndDepthStayUntilTheRingComesRound) {
  for (const VideoDepth depth : {VideoDepth::kFree, VideoDepth::kCoded}) {
    const auto method = make(settings(depth));
    const RenderedFrame first = method->render({.camera = camera_at()});
    const auto octets = [&] {
      return std::vector(first.picture.y, first.picture.y + first.picture.extent.area() * 3 / 2);
    };
    const std::vector<std::uint8_t> before = octets();
    const std::vector<float> distances(first.view->depth.begin(), first.view->depth.end());
    for (int i = 1; i < 3; ++i) method->render({.camera = camera_at(-0.1 * i)});
    EXPECT_EQ(octets(), before);
    EXPECT_TRUE(std::ranges::equal(first.view->depth, distances));
    method->render({.camera = camera_at(-1)});
    EXPECT_NE(octets(), before) << "the slot is used again";
  }
}

TEST_F(Video, HasNoAtlas) {
  const auto method = make(settings(VideoDepth::kNone));
  const RenderedFrame frame = method->render({.camera = camera_at(), .cover = std::chrono::seconds(1)});
  EXPECT_EQ(frame.change, nullptr);
  EXPECT_TRUE(frame.view->depth.empty());
  EXPECT_EQ(frame.visible_patches, 0U);
  EXPECT_EQ(frame.shaded_texels, frame.picture.extent.area());
  EXPECT_TRUE(method->blocks().empty());
  EXPECT_FALSE(method->wants_intra());
  EXPECT_THAT(method_names(), ::testing::Contains("video"));
}

TEST_F(Video, RefusesOddDisplaysAndSmallScales) {
  MethodSettings odd = settings(VideoDepth::kNone);
  odd.video.display = {101, 60};
  EXPECT_THROW((void)make(odd), ProgramError);
  odd.video.display = {100, 61};
  EXPECT_THROW((void)make(odd), ProgramError);
  EXPECT_THROW((void)make(settings(VideoDepth::kNone, 0.9)), ProgramError);
}

}  // namespace
}  // namespace atlaswire::render
