#include "render/image/metrics.h"
#include "render/passes/forward.h"
#include "render/sas/sas_method.h"
#include "render/scene/assemble.h"
#include "render/scene/moved_scene.h"
#include "render/scene/parade.h"
#include "tests/render/gpu/gpu_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace atlaswire::render {
namespace {

constexpr double kTime = 2.3;

std::shared_ptr<const Scene> parade(bool sun) {
  SceneSource source = make_parade({.figures = 2, .cloths = 1, .orbiters = 8});
  if (!sun) source.sun.color = glm::vec3(0.0F);
  return std::make_shared<const Scene>(assemble(std::move(source)).value());
}

/// The same patches in a scene that rests where the other is at a time.
std::shared_ptr<const Scene> frozen(const std::shared_ptr<const Scene>& scene, double seconds) {
  MovedScene moved(scene);
  moved.pose(seconds);
  auto out = std::make_shared<Scene>(*scene);
  out->motion = nullptr;
  for (std::size_t i = 0; i < moved.parts().size(); ++i) {
    const MovingPart& part = moved.parts()[i];
    std::ranges::copy(moved.vertices(i), out->vertices.begin() + part.vertices.first);
    std::ranges::copy(moved.positions(i), out->positions.begin() + part.positions.first);
    for (std::uint32_t c = part.chunks.first; c < part.chunks.end(); ++c)
      out->chunks[c].box = moved.boxes()[c];
  }
  return out;
}

Camera camera() {
  Camera c;
  c.extent = {320, 180};
  c.pose.position = {0, 1.7, 5.5};
  return c;
}

class MovingScene : public test::GpuTest {};

TEST_F(MovingScene, IsDrawnAsOneThatRestsWhereItIs) {
  const auto scene = parade(false);
  SceneGpu moving(device(), scene);
  const SceneGpu resting(device(), frozen(scene, kTime));
  ForwardPass draws_moving(device(), moving);
  ForwardPass draws_resting(device(), resting);
  const Picture rest = draws_moving.render(camera());
  moving.move_to(kTime);
  const Picture moved = draws_moving.render(camera());
  EXPECT_EQ(moved.rgba, draws_resting.render(camera()).rgba);
  EXPECT_NE(moved.rgba, rest.rgba);
  moving.move_to(std::nullopt);
  EXPECT_EQ(draws_moving.render(camera()).rgba, rest.rgba);
}

TEST_F(MovingScene, ShadowsFollow) {
  const auto scene = parade(true);
  SceneGpu moving(device(), scene);
  const SceneGpu resting(device(), frozen(scene, kTime));
  ForwardPass draws_moving(device(), moving);
  ForwardPass draws_resting(device(), resting);
  moving.move_to(kTime);
  // The sun's view is fitted to other bounds, so edges of shadows differ a little.
  const double same = mssim(draws_moving.render(camera()), draws_resting.render(camera()));
  EXPECT_GT(same, 0.98);
  moving.move_to(kTime + 1);
  EXPECT_LT(mssim(draws_moving.render(camera()), draws_resting.render(camera())), same - 0.01);
}

std::vector<std::uint8_t> luma(const RenderedFrame& frame) {
  return {frame.picture.y, frame.picture.y + frame.picture.extent.area()};
}

TEST_F(MovingScene, IsSeenAndShadedAsOneThatRestsWhereItIs) {
  const auto scene = parade(false);
  MethodSettings settings;
  settings.atlas = {512, 512};
  settings.max_views = 1;
  FrameRequest request{.frame = FrameId{0}, .camera = camera(), .intra = true};
  SasMethod resting(device(), frozen(scene, kTime), settings);
  const RenderedFrame wanted = resting.render(request);
  SasMethod moving(device(), scene, settings);
  request.scene_seconds = kTime;
  const RenderedFrame got = moving.render(request);
  EXPECT_TRUE(std::ranges::equal(moving.levels(), resting.levels()));
  EXPECT_EQ(moving.blocks().size(), resting.blocks().size());
  EXPECT_EQ(luma(got), luma(wanted));
  ASSERT_NE(got.moved, nullptr);
  EXPECT_NE(got.moved->version(0), 0U);
}

TEST_F(MovingScene, WhatMovesIsShadedAnewWheneverItMoved) {
  const auto scene = parade(true);
  MethodSettings settings;
  settings.atlas = {512, 512};
  settings.reshade_interval = 1000;
  settings.hold_frames = 0;
  SasMethod method(device(), scene, settings);
  FrameRequest request{.frame = FrameId{0}, .camera = camera(), .intra = true};
  request.scene_seconds = kTime;
  std::uint64_t shaded = method.render(request).shaded_texels;
  for (std::uint32_t i = 1; i < 4; ++i) {
    request.frame = FrameId{i};
    request.intra = false;
    shaded = method.render(request).shaded_texels;
  }
  const auto area_of_movers = [&] {
    std::uint64_t area = 0;
    for (const PlacedPatch& placed : method.blocks()) {
      for (const MovingPart& part : scene->motion->parts) {
        if (value(placed.patch) >= part.mover.first_patch && value(placed.patch) < part.mover.end())
          area += placed.block.area();
      }
    }
    return area;
  };
  EXPECT_LT(shaded, area_of_movers() / 2) << "nothing moves while time stands";
  request.scene_seconds = kTime + 0.05;
  EXPECT_GE(method.render(request).shaded_texels, area_of_movers());
}

}  // namespace
}  // namespace atlaswire::render
