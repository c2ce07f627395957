#include "render/passes/visibility.h"

#include "base/random.h"
#include "render/gpu/barriers.h"
#include "render/gpu/submit_context.h"
#include "shaders/level_layout.h"
#include "tests/render/gpu/gpu_fixture.h"
#include "tests/render/sas/tiny_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

namespace atlaswire::render {
namespace {

using test::TinyScene;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using visibility::kNoPatch;

constexpr Duration kStep = std::chrono::microseconds(33'333);
constexpr PatchClass kOpaque{};
constexpr PatchClass kDoubleSided{.double_sided = true};
constexpr PatchClass kMask{.alpha = PatchClass::Alpha::kMask};
constexpr PatchClass kBlend{.alpha = PatchClass::Alpha::kBlend};

Camera small_camera() {
  Camera camera;
  camera.extent = {96, 64};
  return camera;
}

class Visibility : public test::GpuTest {
 protected:
  struct Seen {
    Extent2D extent;
    std::vector<std::uint32_t> ids;      ///< patches of the last view, row by row
    std::vector<std::uint32_t> patches;  ///< ascending
    std::vector<std::uint32_t> words;
  };

  /// One pass over one scene for a few frames.
  class Viewer {
   public:
    Viewer(std::shared_ptr<const Scene> scene, const VisibilitySettings& settings)
        : scene_(device(), std::move(scene)),
          pass_(device(), scene_, settings),
          max_views_(settings.max_views),
          context_(device(), "view") {}

    Seen see(const Camera& camera, Duration cover = {}) {
      context_.run([&](const vk::raii::CommandBuffer& commands) {
        pass_.record(commands, camera, predicted_poses(camera.pose, cover, kStep, max_views_));
      });
      Seen seen;
      const auto levels = pass_.levels();
      seen.words.assign(levels.begin(), levels.end());
      for (std::uint32_t i = 0; i < levels.size(); ++i) {
        if (levels[i] != 0) seen.patches.push_back(i);
      }
      seen.extent = pass_.ids().extent();
      seen.ids = read_ids();
      return seen;
    }
    [[nodiscard]] const VisibilityStats& stats() const { return pass_.stats(); }

   private:
    std::vector<std::uint32_t> read_ids() {
      Image& ids = pass_.ids();
      const Extent2D extent = ids.extent();
      const Buffer copy(device(), {.name = "ids copy",
                                   .size = extent.area() * 4,
                                   .usage = vk::BufferUsageFlagBits::eTransferDst,
                                   .residence = Residence::kReadback});
      context_.run([&](const vk::raii::CommandBuffer& commands) {
        use_image(commands, ids, ImageUse::kTransferSource);
        commands.copyImageToBuffer(
            ids.handle(), ids.layout(), copy.handle(),
            vk::BufferImageCopy{
                .imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1},
                .imageExtent = {extent.width, extent.height, 1}});
        writes_to_host(commands);
      });
      copy.invalidate();
      const auto words = copy.mapped<std::uint32_t>();
      return {words.begin(), words.end()};
    }

    SceneGpu scene_;
    VisibilityPass pass_;
    std::uint32_t max_views_;
    SubmitContext context_;
  };

  static Seen look(std::shared_ptr<const Scene> scene, const Camera& camera,
                   const VisibilitySettings& settings = {.fov_scale = 1.0}, Duration cover = {}) {
    return Viewer(std::move(scene), settings).see(camera, cover);
  }
};

/// What a pixel shows by casting a ray in double: nothing where an edge passes too close to tell.
std::optional<std::uint32_t> cast(const Scene& scene, const glm::dvec3& eye, const glm::dvec3& ray,
                                  double near_plane) {
  constexpr double kUnsure = 2e-3;
  double nearest = 1e30;
  std::uint32_t id = kNoPatch;
  std::vector<double> unsure;
  for (std::size_t t = 0; t < scene.triangle_patch.size(); ++t) {
    const auto corner = [&](std::size_t i) {
      return glm::dvec3(scene.vertices[scene.indices[3 * t + i]].position) + scene.origin - eye;
    };
    const glm::dvec3 a = corner(0);
    const glm::dvec3 e1 = corner(1) - a;
    const glm::dvec3 e2 = corner(2) - a;
    const glm::dvec3 n = glm::cross(e1, e2);
    const double facing = glm::dot(n, ray);
    const Material& material = scene.materials[scene.patches[scene.triangle_patch[t]].material];
    if (facing > 0 && !material.draw.double_sided) continue;
    if (std::abs(facing) < 1e-9 * glm::length(n)) continue;
    const double distance = glm::dot(n, a) / facing;  // along -Z of the camera: the ray's z is -1
    const glm::dvec3 hit = ray * distance - a;
    const double u = glm::dot(glm::cross(hit, e2), n) / glm::dot(n, n);
    const double v = glm::dot(glm::cross(e1, hit), n) / glm::dot(n, n);
    const double inside = std::min({u, v, 1 - u - v});
    if (distance < near_plane * 0.999 || inside < -kUnsure) continue;
    if (inside < kUnsure || distance < near_plane * 1.001) unsure.push_back(distance);
    if (inside >= 0 && distance < nearest) {
      nearest = distance;
      id = scene.triangle_patch[t];
    }
  }
  for (const double distance : unsure) {
    if (distance <= nearest * 1.0001) return std::nullopt;
  }
  return id;
}

/// Compares every pixel that ray casting is sure of, and demands that those are most.
template <class Seen>
void expect_ray_cast(const Scene& scene, const Camera& camera, const Seen& seen) {
  const double up = std::tan(camera.vertical_fov / 2);
  const double across = up * camera.extent.width / camera.extent.height;
  std::size_t sure = 0;
  std::size_t wrong = 0;
  for (std::uint32_t y = 0; y < seen.extent.height; ++y) {
    for (std::uint32_t x = 0; x < seen.extent.width; ++x) {
      const glm::dvec3 local{(2 * (x + 0.5) / seen.extent.width - 1) * across,
                             (1 - 2 * (y + 0.5) / seen.extent.height) * up, -1};
      const auto id = cast(scene, camera.pose.position, camera.pose.orientation * local, camera.near_plane);
      if (!id) continue;
      ++sure;
      if (*id != seen.ids[y * seen.extent.width + x]) ++wrong;
    }
  }
  EXPECT_GT(sure, seen.extent.area() * 8 / 10);
  EXPECT_EQ(wrong, 0U) << "of " << sure;
}

std::shared_ptr<const Scene> clutter(const glm::dvec3& origin = glm::dvec3{0.0}) {
  TinyScene scene(origin);
  Random random(42);
  const auto draw = [&](double half) { return static_cast<float>((random.uniform() * 2 - 1) * half); };
  for (int material = 0; material < 4; ++material) {
    scene.material(material % 2 == 0 ? kOpaque : kDoubleSided);
    for (int i = 0; i < 20; ++i) {
      const glm::vec3 p{draw(4), draw(4), draw(4)};
      const glm::vec3 u{draw(1), draw(1), draw(1)};
      const glm::vec3 v{draw(1), draw(1), draw(1)};
      if (i % 3 == 0) scene.patch({p, p + u, p + v});
      if (i % 3 == 1) scene.patch({p, p + u, p + u + v, p + v});
      if (i % 3 == 2) scene.patch({p, p + u, p + u + v, p + u * 0.5F + v, p + v});
    }
  }
  return scene.finish();
}

TEST_F(Visibility, EachPixelShowsWhatARayHits) {
  const auto scene = clutter();
  Viewer viewer(scene, {.fov_scale = 1.0});
  Random random(3);
  for (int i = 0; i < 6; ++i) {
    Camera camera = small_camera();
    const auto draw = [&] { return random.uniform() * 2 - 1; };
    // From outside and from within.
    camera.pose.position = glm::dvec3{draw(), draw(), draw()} * (i < 3 ? 6.0 : 1.5);
    camera.pose.orientation = glm::normalize(glm::dquat(draw(), draw(), draw(), draw()));
    const Seen seen = viewer.see(camera);
    expect_ray_cast(*scene, camera, seen);
    std::vector<std::uint32_t> shown(seen.ids);
    std::ranges::sort(shown);
    const auto [first, last] = std::ranges::unique(shown);
    shown.erase(first, last);
    if (!shown.empty() && shown.back() == kNoPatch) shown.pop_back();
    EXPECT_EQ(seen.patches, shown) << "marks are the patches that the id buffer shows";
  }
}

/// Rooms of 4 x 4 x 4 m in a row with a doorway each, and things in them, many chunks behind walls.
std::shared_ptr<const Scene> rooms() {
  TinyScene scene;
  Random random(11);
  const auto draw = [&](double half) { return static_cast<float>((random.uniform() * 2 - 1) * half); };
  for (int room = 0; room < 8; ++room) {
    const auto z = static_cast<float>(-4 * room);
    scene.material(kDoubleSided);
    const float door = draw(1.5F);
    scene.wall(-2, -2, door - 0.3F, 2, z);
    scene.wall(door + 0.3F, -2, 2, 2, z);
    scene.wall(door - 0.3F, 0, door + 0.3F, 2, z);
    for (int thing = 0; thing < 6; ++thing) {
      scene.material(thing % 2 == 0 ? kOpaque : kDoubleSided);
      for (int i = 0; i < 4; ++i) {
        const glm::vec3 p{draw(1.5), draw(1.5), z - 2 + draw(1.5F)};
        scene.patch({p, p + glm::vec3{draw(0.3), draw(0.3), draw(0.3)}, p + glm::vec3{draw(0.3), 0.2, 0.1}});
      }
    }
  }
  // A shell around all, so that tiles are covered and a new chunk must be told to be nearer than they are.
  scene.material(kDoubleSided);
  for (const float side : {-1.0F, 1.0F}) {
    const float d = 40 * side;
    scene.patch({{d, -40, -50}, {d, 40, -50}, {d, 40, 40}, {d, -40, 40}});
    scene.patch({{-40, d, -50}, {40, d, -50}, {40, d, 40}, {-40, d, 40}});
    scene.wall(-40, -40, 40, 40, side < 0 ? -50.0F : 40.0F);
  }
  scene.material(kBlend);
  for (int room = 0; room < 8; ++room) scene.wall(-2, -2, 2, 2, -4.0F * static_cast<float>(room) - 1);
  return scene.finish();
}

TEST_F(Visibility, OcclusionTestChangesNoPixelAndNoPatch) {
  const auto scene = rooms();
  Viewer all(scene, {.fov_scale = 1.0, .max_views = 2, .occlusion = false});
  Viewer tested(scene, {.fov_scale = 1.0, .max_views = 2, .occlusion = true});
  Camera camera = small_camera();
  camera.extent = {240, 160};
  std::uint32_t dropped = 0;
  for (int i = 0; i < 40; ++i) {
    // A walk through the rooms that turns as it goes, with two jumps that make the last frame useless.
    const double at = i < 20 ? 3.0 - 0.7 * i : i < 30 ? -28 + 0.5 * i : 10.0 - 0.8 * i;
    camera.pose.position = {0.8 * std::sin(i * 0.7), 0.3 * std::cos(i * 1.1), at};
    camera.pose.orientation = glm::angleAxis(0.6 * std::sin(i * 0.5), glm::dvec3{0, 1, 0});
    camera.pose.velocity = {0.5, 0, -2};
    const Seen expected = all.see(camera, std::chrono::milliseconds(50));
    const Seen seen = tested.see(camera, std::chrono::milliseconds(50));
    ASSERT_EQ(seen.ids, expected.ids) << "frame " << i;
    ASSERT_EQ(seen.words, expected.words) << "frame " << i;
    dropped += tested.stats().chunks_tested;
  }
  EXPECT_GT(dropped, 0U);
  EXPECT_EQ(all.stats().chunks_tested, 0U);
}

TEST_F(Visibility, HidesWhatIsBehindAndCullsBacksOfSingleSided) {
  TinyScene scene;
  scene.material(kOpaque);
  const PatchId front = scene.wall(-1, -1, 1, 1, -2);
  scene.wall(-1, -1, 1, 1, -3);  // hidden
  const PatchId beside = scene.wall(1.5F, -1, 2, 1, -3);
  scene.patch({{-2, -1, -3}, {-2, 1, -3}, {-1.8F, 1, -3}, {-1.8F, -1, -3}});  // seen from behind
  scene.material(kDoubleSided);
  const PatchId back = scene.patch({{-2.5F, -1, -3}, {-2.5F, 1, -3}, {-2.2F, 1, -3}, {-2.2F, -1, -3}});
  EXPECT_THAT(look(scene.finish(), small_camera()).patches,
              ElementsAre(value(front), value(beside), value(back)));
}

TEST_F(Visibility, MaskedHolesShowWhatIsBehindAndBlendedHidesNothing) {
  TinyScene scene;
  // Left half opaque, right half a hole.
  const std::int32_t half = scene.texture(2, {255, 255, 255, 255, 255, 255, 255, 0,  //
                                              255, 255, 255, 255, 255, 255, 255, 0});
  const std::int32_t clear = scene.texture(1, {255, 255, 255, 0});
  scene.material(kOpaque);
  scene.wall(-0.9F, -0.5F, -0.6F, 0.5F, -4);  // behind the opaque half
  const PatchId through = scene.wall(0.6F, -0.5F, 0.9F, 0.5F, -4);
  scene.wall(-0.9F, -0.5F, -0.6F, 0.5F, -5);
  scene.material(kMask, half);
  const PatchId masked = scene.wall(-1, -1, 1, 1, -2);
  scene.material(kBlend);
  const PatchId pane = scene.wall(-1, -1, 1, 1, -1.5F);
  const PatchId second = scene.wall(-1, -1, 1, 1, -1.8F);
  scene.wall(-0.9F, -0.5F, -0.6F, 0.5F, -3);  // behind the opaque half
  scene.material(kBlend, clear);
  scene.wall(-1, -1, 1, 1, -1.2F);  // nothing of it shows
  const Seen seen = look(scene.finish(), small_camera());
  EXPECT_THAT(seen.patches, ElementsAre(value(through), value(masked), value(pane), value(second)));
}

TEST_F(Visibility, EnlargedViewSeesBesideTheDisplay) {
  // At 60 degrees up and down, 0.577 * 1.5 = 0.866 across at distance 1; at 1.2 times, 1.039.
  TinyScene scene;
  scene.material(kOpaque);
  const PatchId inside = scene.wall(0.5F, -0.1F, 0.8F, 0.1F, -1);
  const PatchId beside = scene.wall(0.9F, -0.1F, 1.0F, 0.1F, -1);
  scene.wall(1.06F, -0.1F, 1.2F, 0.1F, -1);
  const auto made = scene.finish();
  EXPECT_THAT(look(made, small_camera(), {.fov_scale = 1.0}).patches, ElementsAre(value(inside)));
  const Seen wide = look(made, small_camera(), {.fov_scale = 1.2});
  EXPECT_THAT(wide.patches, ElementsAre(value(inside), value(beside)));
  EXPECT_EQ(wide.extent, (Extent2D{116, 78}));
}

TEST_F(Visibility, IdScaleChangesTheIdBufferNotTheView) {
  const auto scene = clutter();
  Camera camera = small_camera();
  camera.pose.position = {0, 0, 6};
  Camera fine = camera;
  fine.extent = {192, 128};
  const Seen coarse = look(scene, camera, {.fov_scale = 1.0, .id_scale = 2.0});
  EXPECT_EQ(coarse.extent, fine.extent);
  EXPECT_EQ(coarse.ids, look(scene, fine, {.fov_scale = 1.0}).ids);
}

TEST_F(Visibility, UnitesThePredictedViews) {
  TinyScene scene;
  scene.material(kOpaque);
  const PatchId now = scene.wall(-0.2F, -0.2F, 0.2F, 0.2F, -2);
  const PatchId later = scene.wall(-0.2F, -0.2F, 0.2F, 0.2F, 30);  // faces +Z, 31 m further
  const auto made = scene.finish();
  Camera camera = small_camera();
  camera.pose.velocity = {0, 0, 320};  // 32 m back in 100 ms
  const VisibilitySettings two{.fov_scale = 1.0, .max_views = 2};
  EXPECT_THAT(look(made, camera, two).patches, ElementsAre(value(now)));
  const auto both = look(made, camera, two, std::chrono::milliseconds(100));
  EXPECT_THAT(both.patches, ElementsAre(value(now), value(later)));
  EXPECT_THAT(look(made, camera, {.fov_scale = 1.0, .max_views = 1}, std::chrono::milliseconds(100)).patches,
              ElementsAre(value(now)));
}

TEST_F(Visibility, FarFromTheOriginItIsTheSameView) {
  Camera camera = small_camera();
  camera.pose.position = {0.3, -0.2, 6.1};
  const Seen near_by = look(clutter(), camera);
  const glm::dvec3 shift{1e6, 2e6, -3e6};
  camera.pose.position += shift;
  const Seen far_off = look(clutter(shift), camera);
  EXPECT_FALSE(near_by.patches.empty());
  EXPECT_EQ(near_by.patches, far_off.patches);
}

TEST_F(Visibility, EmptyViewIsAnEmptySetAndLeavesNoMarks) {
  TinyScene scene;
  scene.material(kOpaque);
  const PatchId wall = scene.wall(-1, -1, 1, 1, -2);
  Viewer viewer(scene.finish(), {.fov_scale = 1.2});
  Camera away = small_camera();
  away.pose.orientation = {0, 0, 1, 0};
  EXPECT_THAT(viewer.see(away).patches, IsEmpty());
  EXPECT_THAT(viewer.see(small_camera()).patches, ElementsAre(value(wall)));
  EXPECT_THAT(viewer.see(away).patches, IsEmpty());
}

TEST_F(Visibility, FollowsADisplayThatChangesSize) {
  const auto scene = clutter();
  Viewer viewer(scene, {.fov_scale = 1.0});
  Camera camera = small_camera();
  camera.pose.position = {0, 0, 7};
  for (const Extent2D extent : {Extent2D{96, 64}, Extent2D{33, 17}, Extent2D{128, 40}, Extent2D{96, 64}}) {
    camera.extent = extent;
    const Seen seen = viewer.see(camera);
    Camera used = camera;
    used = enlarged(camera, 1.0);
    EXPECT_EQ(seen.extent, used.extent);
    expect_ray_cast(*scene, used, seen);
  }
}

TEST_F(Visibility, LevelsAreThoseOfTheCurrentPoseInDisplayPixels) {
  // One square metre facing the camera at 100 m: pixels per radian / 100 steps a side, whatever the id
  // buffer's scale.
  TinyScene scene;
  scene.material(kOpaque);
  const PatchId wall = scene.wall(-0.5F, -0.5F, 0.5F, 0.5F, -100);
  const auto made = scene.finish();
  Camera camera = small_camera();
  camera.extent = {1920, 1080};
  const double pixels = 1080 / 2.0 / std::tan(camera.vertical_fov / 2) / 100;
  for (const double id_scale : {0.5, 1.0}) {
    const Seen seen = look(made, camera, {.fov_scale = 1.2, .id_scale = id_scale});
    ASSERT_THAT(seen.patches, ElementsAre(value(wall)));
    EXPECT_NEAR(level_log2_area(seen.words[0]), 2 * std::log2(pixels + 1), 0.01);
    EXPECT_NEAR(level_log2_aspect(seen.words[0]), 0, 0.01);
  }
}

TEST_F(Visibility, LevelsLeaveRoomForTheHalfTexelAtABlocksEdges) {
  // U x V pixels want (U + 1) x (V + 1) texels; a sliver no more than four for each of its pixels.
  TinyScene scene;
  scene.material(kOpaque);
  scene.wall(-0.5F, -0.25F, 0.5F, 0.25F, -10);
  scene.wall(-2, 1, 2, 1.004F, -10);  // 0.4 pixels high
  const auto made = scene.finish();
  Camera camera = small_camera();
  camera.extent = {1920, 1080};
  const double pixels = 1080 / 2.0 / std::tan(camera.vertical_fov / 2) / 10;
  const Seen seen = look(made, camera, {.fov_scale = 1.2, .id_scale = 2.0});
  ASSERT_EQ(seen.patches.size(), 2U);
  EXPECT_NEAR(level_log2_area(seen.words[0]), std::log2((pixels + 1) * (pixels / 2 + 1)), 0.02);
  EXPECT_NEAR(level_log2_aspect(seen.words[0]), std::log2((pixels + 1) / (pixels / 2 + 1)), 0.02);
  EXPECT_NEAR(level_log2_area(seen.words[1]), 2 + 2 * std::log2(pixels) + std::log2(4 * 0.004), 0.2);
}

TEST_F(Visibility, HoldsWhatItSawForSomeFrames) {
  TinyScene scene;
  scene.material(kOpaque);
  const PatchId wall = scene.wall(-0.04F, -0.04F, 0.04F, 0.04F, -2);  // two pixels wide
  Viewer viewer(scene.finish(), {.fov_scale = 1.2, .hold_frames = 2});
  Camera away = small_camera();
  away.pose.orientation = {0, 0, 1, 0};
  EXPECT_THAT(viewer.see(away).patches, IsEmpty());
  for (int times = 0; times < 2; ++times) {
    EXPECT_THAT(viewer.see(small_camera()).patches, ElementsAre(value(wall)));
    EXPECT_THAT(viewer.see(away).patches, ElementsAre(value(wall)));
    EXPECT_THAT(viewer.see(away).patches, ElementsAre(value(wall)));
    EXPECT_THAT(viewer.see(away).patches, IsEmpty());
  }
  // Seen again while it is held, it is held anew.
  viewer.see(small_camera());
  viewer.see(away);
  viewer.see(small_camera());
  viewer.see(away);
  EXPECT_THAT(viewer.see(away).patches, ElementsAre(value(wall)));
  EXPECT_THAT(viewer.see(away).patches, IsEmpty());
}

}  // namespace
}  // namespace atlaswire::render
