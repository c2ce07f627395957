#include "render/sas/sas_method.h"

#include "base/program.h"
#include "render/scene/load.h"
#include "shaders/level_layout.h"
#include "tests/render/gpu/gpu_fixture.h"
#include "tests/render/sas/tiny_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <thread>

namespace atlaswire::render {
namespace {

using ::testing::HasSubstr;

constexpr PatchClass kOpaque{};
constexpr PatchClass kBlend{.alpha = PatchClass::Alpha::kBlend};

/// A corridor along -Z with a tiled floor, ceiling and walls, lit from above; a glass door if asked.
std::shared_ptr<const Scene> corridor(bool glass) {
  test::TinyScene scene;
  for (int i = 0; i < 12; ++i) {
    scene.material(kOpaque);
    const auto z = static_cast<float>(-i);
    scene.patch({{-1, -1, z}, {1, -1, z}, {1, -1, z - 1}, {-1, -1, z - 1}});  // floor
    scene.patch({{-1, 1, z}, {-1, 1, z - 1}, {1, 1, z - 1}, {1, 1, z}});      // ceiling
    scene.patch({{-1, -1, z}, {-1, -1, z - 1}, {-1, 1, z - 1}, {-1, 1, z}});  // left
    scene.patch({{1, -1, z}, {1, 1, z}, {1, 1, z - 1}, {1, -1, z - 1}});      // right
  }
  scene.wall(-1, -1, 1, 1, -12);
  if (glass) {
    scene.material(kBlend);
    scene.wall(-1, -1, 1, 1, -5);
  }
  return scene.finish();
}

FrameRequest request(std::uint32_t frame, bool intra) {
  FrameRequest r{.frame = FrameId{frame}, .intra = intra};
  r.camera.extent = {160, 120};
  r.camera.pose.position = {0.1, 0.05, -0.2 - 0.05 * frame};
  r.camera.pose.velocity = {0, 0, -1.5};
  r.cover = std::chrono::milliseconds(60);
  return r;
}

class Sas : public test::GpuTest {
 protected:
  static MethodSettings small() {
    MethodSettings s;
    s.atlas = {256, 256};
    return s;
  }
  static std::vector<std::uint8_t> planes(const I420Picture& p) {
    std::vector<std::uint8_t> all(p.y, p.y + p.extent.area());
    all.insert(all.end(), p.u, p.u + p.extent.area() / 4);
    all.insert(all.end(), p.v, p.v + p.extent.area() / 4);
    return all;
  }
};

TEST_F(Sas, TwoEyesSeePastWhatHidesAPatchFromTheMiddle) {
  test::TinyScene scene;
  scene.material(kOpaque);
  scene.wall(-0.01F, -0.2F, 0.01F, 0.2F, -0.5F);
  const PatchId behind = scene.wall(-0.02F, -0.1F, 0.02F, 0.1F, -2);
  const auto made = scene.finish();
  FrameRequest r{.frame = FrameId{0}, .intra = true};
  r.camera.extent = {160, 120};
  EXPECT_EQ(SasMethod(device(), made, small()).render(r).visible_patches, 1U);
  r.hints.eye_separation = 0.1;
  SasMethod both(device(), made, small());
  EXPECT_EQ(both.render(r).visible_patches, 2U);
  EXPECT_NE(both.levels()[value(behind)], 0U);
}

TEST_F(Sas, ForeseenPosesStandInForPrediction) {
  const auto scene = corridor(false);
  FrameRequest r{.frame = FrameId{0}, .intra = true};
  r.camera.extent = {160, 120};
  r.camera.pose.position = {0, 0, -6};
  r.cover = std::chrono::milliseconds(60);
  SasMethod method(device(), scene, small());
  const std::uint32_t ahead = method.render(r).visible_patches;
  Pose back = r.camera.pose;
  back.orientation = glm::dquat{0, 0, 1, 0};  // half a turn about +Y
  r.hints.foreseen = {r.camera.pose, back};
  EXPECT_GT(SasMethod(device(), scene, small()).render(r).visible_patches, ahead);
}

TEST_F(Sas, EmphasisCountsFromTheNextFrameOn) {
  test::TinyScene builder;
  builder.material(kOpaque);
  const PatchId middle = builder.wall(-0.1F, -0.1F, 0.1F, 0.1F, -2);
  const PatchId rim = builder.wall(0.8F, -0.1F, 1.0F, 0.1F, -2);
  const auto scene = builder.finish();
  MethodSettings settings = small();
  settings.emphasis.priorities = {{"", 1}};  // the material has no name
  SasMethod method(device(), scene, settings);
  FrameRequest r{.frame = FrameId{0}, .intra = true};
  r.camera.extent = {160, 120};
  const auto level = [&](PatchId patch) { return level_log2_area(method.levels()[value(patch)]); };
  method.render(r);
  const double middle_before = level(middle);
  const double rim_before = level(rim);
  method.set_emphasis({.foveation = 4.0, .priorities = {{"", 3}}});
  method.render(r);
  EXPECT_NEAR(level(middle), middle_before + 2, 0.01);
  EXPECT_LT(level(rim), rim_before + 1.5)
      << "0.38 rad from the axis, at 4 octaves a radian beyond 10 degrees";
  method.set_emphasis({});
  method.render(r);
  EXPECT_NEAR(level(middle), middle_before - 1, 0.01) << "nothing of before is left";
  EXPECT_NEAR(level(rim), rim_before - 1, 0.01);
}

TEST_F(Sas, PlansTheSameLayoutOnTheDeviceAsOnTheHost) {
  const auto scene = corridor(true);
  MethodSettings settings = small();
  settings.atlas = {128, 128};  // too small for all: levels are pressed
  settings.allocator.superblock_log2 = 5;
  settings.allocator_kind = AllocatorKind::kSequential;
  SasMethod host(device(), scene, settings);
  settings.allocator_kind = AllocatorKind::kDevice;
  SasMethod on_device(device(), scene, settings);
  for (std::uint32_t i = 0; i < 12; ++i) {
    const RenderedFrame a = host.render(request(i, i % 5 == 0));
    const RenderedFrame b = on_device.render(request(i, i % 5 == 0));
    EXPECT_EQ(a.bias, b.bias);
    EXPECT_EQ(a.visible_patches, b.visible_patches);
    EXPECT_EQ(a.usage.allocated, b.usage.allocated);
    EXPECT_EQ(planes(a.picture), planes(b.picture)) << "frame " << i;
    EXPECT_EQ(host.wants_intra(), on_device.wants_intra());
  }
}

TEST_F(Sas, EveryVisiblePatchHoldsAShadedBlock) {
  const auto scene = corridor(false);
  SasMethod method(device(), scene, small());
  const RenderedFrame frame = method.render(request(0, true));
  EXPECT_EQ(frame.frame, FrameId{0});
  ASSERT_NE(frame.change, nullptr);
  EXPECT_TRUE(frame.change->refused.empty());
  std::set<std::uint32_t> visible;
  for (std::uint32_t i = 0; i < method.levels().size(); ++i) {
    if (method.levels()[i] != 0) visible.insert(i);
  }
  EXPECT_GT(visible.size(), 20U);
  EXPECT_EQ(frame.visible_patches, visible.size());
  std::set<std::uint32_t> placed;
  std::uint64_t texels = 0;
  for (const PlacedPatch& p : method.blocks()) {
    placed.insert(value(p.patch));
    texels += p.block.area();
    // The ambient light alone makes every block brighter than black.
    const std::size_t at =
        (p.block.y + p.block.height() / 2) * frame.picture.extent.width + p.block.x + p.block.width() / 2;
    EXPECT_GT(frame.picture.y[at], 20) << "patch " << value(p.patch);
  }
  EXPECT_EQ(placed, visible);
  EXPECT_EQ(frame.usage.allocated, texels);
  EXPECT_GT(frame.shaded_texels, 0U);
  EXPECT_GT(frame.timings.visibility.count(), 0);
  EXPECT_GT(frame.timings.shading.count(), 0);
}

TEST_F(Sas, EqualRequestsGiveEqualBytes) {
  const auto scene = corridor(true);
  MethodSettings settings = small();
  settings.reshade_interval = 3;
  SasMethod a(device(), scene, settings);
  SasMethod b(device(), scene, settings);
  for (std::uint32_t i = 0; i < 7; ++i) {
    const RenderedFrame fa = a.render(request(i, i % 5 == 0));
    const RenderedFrame fb = b.render(request(i, i % 5 == 0));
    EXPECT_EQ(planes(fa.picture), planes(fb.picture)) << "frame " << i;
    EXPECT_EQ(fa.shaded_texels, fb.shaded_texels);
    EXPECT_EQ(fa.visible_patches, fb.visible_patches);
  }
}

TEST_F(Sas, ChangesLeadFromEachFramesBlocksToTheNext) {
  SasMethod method(device(), corridor(true), small());
  std::map<std::uint32_t, Block> mirror;
  for (std::uint32_t i = 0; i < 12; ++i) {
    const RenderedFrame frame = method.render(request(3 * i, i % 5 == 0));
    for (const PatchId p : frame.change->removed) EXPECT_EQ(mirror.erase(value(p)), 1U);
    for (const PlacedPatch& p : frame.change->added)
      EXPECT_TRUE(mirror.emplace(value(p.patch), p.block).second);
    for (const PlacedPatch& p : frame.change->moved) mirror.at(value(p.patch)) = p.block;
    std::map<std::uint32_t, Block> blocks;
    for (const PlacedPatch& p : method.blocks()) blocks.emplace(value(p.patch), p.block);
    EXPECT_EQ(mirror, blocks) << "frame " << i;
  }
}

TEST_F(Sas, ReshadesEachBlockWithinTheInterval) {
  MethodSettings settings = small();
  settings.reshade_interval = 4;
  SasMethod method(device(), corridor(false), settings);
  // A viewer who stands still: after the first frame nothing is new.
  const std::uint64_t all = method.render(request(0, true)).shaded_texels;
  std::uint64_t sum = 0;
  for (std::uint32_t i = 1; i <= 4; ++i) {
    FrameRequest still = request(0, false);
    still.frame = FrameId{i};
    const RenderedFrame frame = method.render(still);
    EXPECT_TRUE(frame.change->added.empty());
    EXPECT_TRUE(frame.change->moved.empty());
    EXPECT_LT(frame.shaded_texels, all);
    sum += frame.shaded_texels;
  }
  EXPECT_EQ(sum, all);
}

TEST_F(Sas, IntraFramesClearWhatNoPatchHolds) {
  MethodSettings settings = small();
  settings.hold_frames = 0;
  SasMethod method(device(), corridor(false), settings);
  (void)method.render(request(0, true));
  FrameRequest away = request(1, true);
  away.camera.pose.orientation = {0, 0, 1, 0};  // out of the corridor's open end
  const RenderedFrame frame = method.render(away);
  EXPECT_EQ(frame.visible_patches, 0U);
  EXPECT_TRUE(method.blocks().empty());
  const auto [low, high] =
      std::minmax_element(frame.picture.y, frame.picture.y + frame.picture.extent.area());
  EXPECT_EQ(*low, *high);
}

TEST_F(Sas, CoveragePlaneLiesBelowTheAtlasOnlyForAlpha) {
  SasMethod solid(device(), corridor(false), small());
  EXPECT_EQ(solid.picture_extent(), (Extent2D{256, 256}));
  SasMethod glass(device(), corridor(true), small());
  EXPECT_EQ(glass.picture_extent(), (Extent2D{256, 512}));
  const RenderedFrame frame = glass.render(request(0, true));
  EXPECT_EQ(frame.picture.extent, glass.picture_extent());
  for (const PlacedPatch& p : glass.blocks()) {
    const std::size_t at = (256 + p.block.y) * std::size_t{256} + p.block.x;
    EXPECT_EQ(frame.picture.y[at], 255) << "this glass is opaque";
  }
}

TEST_F(Sas, IntraFramesOfAnyIntervalLookTheSameWhereNoPatchIs) {
  // With an interval, an intra frame shades no more than others; what it leaves must still be clean.
  const auto scene = corridor(false);
  MethodSettings settings = small();
  settings.reshade_interval = 4;
  SasMethod method(device(), scene, settings);
  for (std::uint32_t i = 0; i < 10; ++i) {
    FrameRequest turning = request(i, i % 3 == 0);
    turning.camera.pose.orientation = glm::angleAxis(0.3 * i, glm::dvec3{0, 1, 0});
    const RenderedFrame frame = method.render(turning);
    if (!turning.intra) continue;
    std::vector<bool> held(256 * 256, false);
    for (const PlacedPatch& p : method.blocks()) {
      for (std::uint32_t t = 0; t < p.block.area(); ++t) {
        held[(p.block.y + t / p.block.width()) * std::size_t{256} + p.block.x + t % p.block.width()] = true;
      }
    }
    std::set<std::uint8_t> unheld;
    for (std::size_t t = 0; t < held.size(); ++t) {
      if (!held[t]) unheld.insert(frame.picture.y[t]);
    }
    EXPECT_LE(unheld.size(), 1U) << "frame " << i;
  }
}

TEST_F(Sas, AtriumRunsCleanAndRepeats) {
  auto loaded = load_scene("atrium:0.05");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().message();
  const auto scene = std::make_shared<const Scene>(std::move(*loaded));
  MethodSettings settings;
  settings.atlas = {512, 512};
  settings.reshade_interval = 2;
  SasMethod a(device(), scene, settings);
  SasMethod b(device(), scene, settings);
  for (std::uint32_t i = 0; i < 4; ++i) {
    FrameRequest r{.frame = FrameId{i}, .intra = i == 0};
    r.camera.extent = {320, 180};
    r.camera.pose = scene->start;
    r.camera.pose.position.x += 0.1 * i;
    r.camera.pose.angular_velocity = {0, 0.5, 0};
    r.cover = std::chrono::milliseconds(50);
    const RenderedFrame frame = a.render(r);
    const auto picture = planes(frame.picture);
    EXPECT_EQ(picture, planes(b.render(r).picture)) << "frame " << i;
    EXPECT_GT(frame.visible_patches, 100U);
    EXPECT_EQ(a.blocks().size() + frame.change->refused.size(), frame.visible_patches);
    EXPECT_TRUE(frame.change->refused.empty());
    std::set<std::uint8_t> shades(picture.begin(), picture.begin() + 512 * 512);
    EXPECT_GT(shades.size(), 50U) << "a lit scene has many shades";
  }
}

TEST_F(Sas, StreamsOnThreadsOfTheirOwnShareADevice) {
  const auto scene = corridor(true);
  const auto film = [&] {
    SasMethod method(device(), scene, small());
    std::vector<std::uint8_t> all;
    for (std::uint32_t i = 0; i < 5; ++i) {
      const auto picture = planes(method.render(request(i, i == 0)).picture);
      all.insert(all.end(), picture.begin(), picture.end());
    }
    return all;
  };
  const auto alone = film();
  std::vector<std::vector<std::uint8_t>> together(3);
  {
    std::vector<std::jthread> threads;
    for (auto& result : together) threads.emplace_back([&] { result = film(); });
  }
  for (const auto& result : together) EXPECT_EQ(result, alone);
}

TEST_F(Sas, MakeMethodNamesTheKnownOnes) {
  EXPECT_THAT(method_names(), ::testing::Contains("sas"));
  try {
    (void)make_method("sass", device(), corridor(false), small());
    FAIL();
  } catch (const ProgramError& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    EXPECT_THAT(error.what(), HasSubstr("sas"));
  }
  MethodSettings bad = small();
  bad.reshade_interval = 0;
  EXPECT_THROW((void)make_method("sas", device(), corridor(false), bad), ProgramError);
}

}  // namespace
}  // namespace atlaswire::render
