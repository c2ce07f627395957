#include "render/warp/view_warp.h"

#include "base/program.h"
#include "render/image/metrics.h"
#include "render/method.h"
#include "render/passes/forward.h"
#include "render/warp/pixel_transfer.h"
#include "tests/render/gpu/gpu_fixture.h"
#include "tests/render/passes/picture_checks.h"
#include "tests/render/passes/scene_builder.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace atlaswire::render {
namespace {

using test::expect_pixel;
using test::glowing;
using test::SceneBuilder;

constexpr double kWallDistance = 6;
constexpr double kCardDistance = 2;
constexpr WarpKind kAll[] = {WarpKind::kTimeWarp, WarpKind::kMesh, WarpKind::kIterative};
constexpr WarpKind kWithDepth[] = {WarpKind::kMesh, WarpKind::kIterative};

/// 9 x 9 dark texels of one colour with the middle one white.
Texture marked(const std::string& name, const Rgba8& color) {
  Texture t{.name = name, .extent = {9, 9}, .rgba = {}, .nearest = true};
  for (int i = 0; i < 81; ++i) {
    const Rgba8 texel = i == 40 ? Rgba8{255, 255, 255, 255} : color;
    t.rgba.insert(t.rgba.end(), texel.begin(), texel.end());
  }
  return t;
}

std::uint16_t marked_material(SceneBuilder& builder, const std::string& name, const Rgba8& color) {
  Material m = glowing({1, 1, 1});
  m.emissive_texture = builder.texture(marked(name, color));
  return builder.material(m);
}

/// A wall with a white mark at (0, 0, -6), before it a card to the right with its mark at (0.9, 0, -2), and
/// sky above the wall from height 3 on.
std::shared_ptr<const Scene> card_and_wall() {
  SceneBuilder builder;
  builder.scene.background = {0.1F, 0.2F, 0.8F};
  const std::uint16_t wall = marked_material(builder, "wall", {0, 60, 0, 255});
  const std::uint16_t card = marked_material(builder, "card", {60, 0, 0, 255});
  const auto far = static_cast<float>(-kWallDistance);
  const auto near = static_cast<float>(-kCardDistance);
  builder.rectangle(wall, {-3, -3, far}, {6, 0, 0}, {0, 6, 0});
  builder.rectangle(wall, {-19, -3, far}, {16, 0, 0}, {0, 6, 0});
  builder.rectangle(wall, {3, -3, far}, {16, 0, 0}, {0, 6, 0});
  builder.rectangle(wall, {-19, -19, far}, {38, 0, 0}, {0, 16, 0});
  builder.rectangle(card, {0.42F, -0.48F, near}, {0.96F, 0, 0}, {0, 0.96F, 0});
  return builder.build();
}

Camera display_camera(const glm::dvec3& position = {0, 0, 0}, double yaw = 0) {
  return {.pose = {.position = position, .orientation = glm::angleAxis(yaw, glm::dvec3{0, 1, 0})},
          .vertical_fov = std::numbers::pi / 2,
          .extent = {160, 120}};
}

I420Planes planes_of(const I420Picture& p) {
  return {p.extent, p.y, p.u, p.v, p.extent.width, p.extent.width / 2};
}

class ViewWarpTest : public test::GpuTest {
 protected:
  explicit ViewWarpTest(std::shared_ptr<const Scene> scene = card_and_wall())
      : scene_(std::move(scene)), gpu_(device(), scene_), forward_(device(), gpu_) {}

  /// The server's side at a display's camera.
  WarpSource source(const Camera& display, double fov_scale = 1.25) {
    MethodSettings settings;
    settings.fov_scale = fov_scale;
    settings.video = {.display = display.extent, .depth = VideoDepth::kFree};
    method_ = make_method("video", device(), scene_, settings);
    const RenderedFrame frame = method_->render({.camera = display});
    return {.camera = frame.view->camera, .colors = planes_of(frame.picture), .depth = frame.view->depth};
  }
  [[nodiscard]] std::unique_ptr<ViewWarp> warp(WarpKind kind) const {
    return make_view_warp(kind, device(), background());
  }
  [[nodiscard]] glm::vec3 background() const { return display_color(scene_->background, scene_->exposure); }
  Picture warped(WarpKind kind, const WarpSource& from, const Camera& camera) const {
    const auto w = warp(kind);
    w->show(from);
    w->draw(camera);
    return w->read_back();
  }
  Picture truth(const Camera& camera) { return forward_.render(camera); }

  std::shared_ptr<const Scene> scene_;
  SceneGpu gpu_;
  ForwardPass forward_;
  std::unique_ptr<Method> method_;
};

/// BT.709 full range with chroma replicated, of the middle of a picture.
Picture middle_of(const I420Planes& p, Extent2D extent) {
  Picture out(extent);
  const std::uint32_t left = (p.extent.width - extent.width) / 2;
  const std::uint32_t top = (p.extent.height - extent.height) / 2;
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 0; x < extent.width; ++x) {
      const std::size_t luma_at = std::size_t{y + top} * p.y_stride + x + left;
      const std::size_t chroma_at = std::size_t{(y + top) / 2} * p.uv_stride + (x + left) / 2;
      const double luma = p.y[luma_at];
      const double blue = p.u[chroma_at] - 128.0;
      const double red = p.v[chroma_at] - 128.0;
      const auto octet = [](double v) { return static_cast<std::uint8_t>(std::clamp(v + 0.5, 0.0, 255.0)); };
      out.set(x, y,
              {octet(luma + 1.5748 * red), octet(luma - 0.18732427 * blue - 0.46812427 * red),
               octet(luma + 1.8556 * blue), 255});
    }
  }
  return out;
}

int largest_difference(const Picture& a, const Picture& b) {
  int most = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    most = std::max(most, std::abs(int{a.rgba[i]} - int{b.rgba[i]}));
  }
  return most;
}

TEST_F(ViewWarpTest, TheSourcesOwnCameraSeesTheSourceItself) {
  for (const WarpKind kind : kAll) {
    for (const double fov_scale : {1.0, 1.2, 1.25}) {
      const Camera camera = display_camera({0.1, 0.2, 0.3}, 0.1);
      const WarpSource from = source(camera, fov_scale);
      const Picture picture = warped(kind, from, camera);
      EXPECT_LE(largest_difference(picture, middle_of(from.colors, camera.extent)), 3)
          << static_cast<int>(kind) << " at " << fov_scale;
    }
  }
}

TEST_F(ViewWarpTest, TheWholeSourceIsShownUpToItsBorder) {
  const WarpSource from = source(display_camera());
  for (const WarpKind kind : kAll) {
    EXPECT_EQ(hole_share(warped(kind, from, from.camera)), 0) << static_cast<int>(kind);
  }
}

TEST_F(ViewWarpTest, RotationAloneIsNearlyExactForAll) {
  const WarpSource from = source(display_camera());
  const Camera turned = display_camera({0, 0, 0}, 0.08);
  const Picture expected = truth(turned);
  for (const WarpKind kind : kAll) {
    const Picture picture = warped(kind, from, turned);
    EXPECT_EQ(hole_share(picture), 0);
    EXPECT_GT(psnr(expected, picture), 30) << static_cast<int>(kind);
    EXPECT_GT(mssim(expected, picture), 0.98) << static_cast<int>(kind);
  }
  EXPECT_GT(psnr(warped(WarpKind::kTimeWarp, from, turned), warped(WarpKind::kMesh, from, turned)), 45);
  EXPECT_GT(psnr(warped(WarpKind::kTimeWarp, from, turned), warped(WarpKind::kIterative, from, turned)), 45);
}

/// Where the white pixels around a place have their middle, weighted by whiteness.
glm::dvec2 white_middle(const Picture& picture, const glm::dvec2& around) {
  double weight = 0;
  glm::dvec2 sum{0.0};
  for (std::uint32_t y = 0; y < picture.extent.height; ++y) {
    for (std::uint32_t x = 0; x < picture.extent.width; ++x) {
      const glm::dvec2 at{x + 0.5, y + 0.5};
      if (glm::length(at - around) > 14) continue;
      const Rgba8 p = picture.at(x, y);
      const double white = std::max(0, std::min({p[0], p[1], p[2]}) - 40);
      weight += white;
      sum += white * at;
    }
  }
  return sum / weight;
}

/// A scene point's pixel and inverse distance in the source.
glm::dvec3 in_source(const Camera& source, const glm::dvec3& point) {
  const glm::dvec3 p = glm::conjugate(source.pose.orientation) * (point - source.pose.position);
  const double focal = source.extent.height / 2.0 / std::tan(source.vertical_fov / 2);
  return {source.extent.width / 2.0 - focal * p.x / p.z, source.extent.height / 2.0 + focal * p.y / p.z,
          -1 / p.z};
}

TEST_F(ViewWarpTest, MovedMarksLandWhereReprojectionPutsThem) {
  const WarpSource from = source(display_camera());
  const Camera moved = display_camera({0.15, 0.1, -0.2}, 0.05);
  const PixelTransfer transfer = pixel_transfer(from.camera, moved);
  for (const glm::dvec3& mark : {glm::dvec3{0, 0, -kWallDistance}, glm::dvec3{0.9, 0, -kCardDistance}}) {
    const glm::dvec3 seen = in_source(from.camera, mark);
    for (const WarpKind kind : kAll) {
      const double w = kind == WarpKind::kTimeWarp ? 0 : seen.z;
      const glm::dvec3 h = transfer.homography * glm::dvec3{seen.x, seen.y, 1} + w * transfer.parallax;
      const glm::dvec2 expected{h.x / h.z, h.y / h.z};
      const glm::dvec2 got = white_middle(warped(kind, from, moved), expected);
      EXPECT_NEAR(got.x, expected.x, 0.3) << static_cast<int>(kind) << " distance " << -mark.z;
      EXPECT_NEAR(got.y, expected.y, 0.3) << static_cast<int>(kind) << " distance " << -mark.z;
    }
  }
}

TEST_F(ViewWarpTest, WhatIsNearHidesWhatIsFar) {
  const WarpSource from = source(display_camera());
  // Either way the card moves over wall that the source saw, and away from wall that it did not.
  for (const double aside : {0.2, -0.2}) {
    const Camera moved = display_camera({aside, 0, 0});
    const Picture expected = truth(moved);
    const auto column = [&](double x) { return 80 + 60 * (x - aside) / kCardDistance; };
    for (const WarpKind kind : kWithDepth) {
      const Picture picture = warped(kind, from, moved);
      for (std::uint32_t x = 10; x < 150; ++x) {
        const auto near_to = [&](double place, double pixels) { return std::abs(x + 0.5 - place) < pixels; };
        const double wall_mark = 80 - 60 * aside / kWallDistance;
        const double hidden_side = aside > 0 ? column(1.38) : column(0.42);
        if (near_to(wall_mark, 6) || near_to(column(0.9), 4) || near_to(hidden_side, 7)) continue;
        if (near_to(column(0.42), 1.5) || near_to(column(1.38), 1.5)) continue;
        expect_pixel(picture, x, 60, expected.at(x, 60), 8);
      }
    }
  }
}

TEST_F(ViewWarpTest, DepthBeatsRotationAloneWhenTheViewerWalks) {
  const WarpSource from = source(display_camera());
  const Camera moved = display_camera({0.15, 0.05, -0.1});
  const Picture expected = truth(moved);
  const double flat = mssim(expected, warped(WarpKind::kTimeWarp, from, moved));
  for (const WarpKind kind : kWithDepth) {
    EXPECT_GT(mssim(expected, warped(kind, from, moved)), flat + 0.01) << static_cast<int>(kind);
  }
}

TEST_F(ViewWarpTest, OutsideTheSourceIsBackgroundWithoutAlpha) {
  const WarpSource from = source(display_camera());
  for (const WarpKind kind : kAll) {
    const Picture turned = warped(kind, from, display_camera({0, 0, 0}, 0.9));
    EXPECT_NEAR(hole_share(turned), hole_share(warped(WarpKind::kTimeWarp, from, display_camera({}, 0.9))),
                0.001);
    EXPECT_GT(hole_share(turned), 0.3);
    expect_pixel(turned, 2, 60, test::displayed(scene_->background, 0), 1);
    EXPECT_EQ(turned.at(157, 60)[3], 255);
    EXPECT_EQ(hole_share(warped(kind, from, display_camera({0, 0, 0}, std::numbers::pi))), 1);
  }
}

TEST_F(ViewWarpTest, SkyIsInfinitelyFarAndShown) {
  const WarpSource from = source(display_camera());
  const Camera moved = display_camera({0.3, -0.2, 0.1});
  for (const WarpKind kind : kAll) {
    const Picture picture = warped(kind, from, moved);
    for (const std::uint32_t x : {5U, 80U, 150U}) {
      expect_pixel(picture, x, 3, test::displayed(scene_->background), 2);
    }
  }
}

TEST_F(ViewWarpTest, AnotherFieldOfViewAndExtentShowTheSameScene) {
  const WarpSource from = source(display_camera());
  Camera narrow = display_camera({0.05, 0, -0.05});
  narrow.vertical_fov = 1.0;
  narrow.extent = {90, 70};
  const Picture expected = truth(narrow);
  for (const WarpKind kind : kWithDepth) {
    EXPECT_GT(mssim(expected, warped(kind, from, narrow)), 0.9) << static_cast<int>(kind);
  }
}

TEST_F(ViewWarpTest, ShowsTheNewestSourceOfAnyExtent) {
  const Camera camera = display_camera();
  Camera small = camera;
  small.extent = {80, 60};
  for (const WarpKind kind : kAll) {
    const auto w = warp(kind);
    w->show(source(camera));
    w->draw(camera);
    const Picture first = w->read_back();
    w->show(source(small));
    w->draw(small);
    EXPECT_EQ(w->read_back(), warped(kind, source(small), small));
    w->show(source(camera));
    w->draw(camera);
    EXPECT_EQ(w->read_back(), first);
  }
}

TEST_F(ViewWarpTest, NothingIsReadBackBeforeTheFirstDraw) {
  const auto w = warp(WarpKind::kMesh);
  EXPECT_TRUE(w->read_back().empty());
  EXPECT_EQ(w->target(), nullptr);
}

TEST_F(ViewWarpTest, RefusesASearchWithoutSteps) {
  EXPECT_THROW((void)make_view_warp(WarpKind::kIterative, device(), background(), {.iterations = 0}),
               ProgramError);
  EXPECT_THROW((void)make_view_warp(WarpKind::kIterative, device(), background(), {.starts = 1}),
               ProgramError);
}

class EmptyViewWarpTest : public ViewWarpTest {
 protected:
  EmptyViewWarpTest() : ViewWarpTest(SceneBuilder().build()) {}
};

TEST_F(EmptyViewWarpTest, ASceneOfNothingIsAllSky) {
  const WarpSource from = source(display_camera());
  EXPECT_TRUE(std::ranges::all_of(from.depth, [](float z) { return std::isinf(z); }));
  for (const WarpKind kind : kAll) {
    EXPECT_EQ(hole_share(warped(kind, from, display_camera({1, 2, 3}))), 0) << static_cast<int>(kind);
  }
}

}  // namespace
}  // namespace atlaswire::render
