#include "render/camera.h"

#include "render/passes/frustum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace atlaswire::render {
namespace {

glm::vec3 projected(const Camera& camera, const glm::vec3& p) {
  const glm::vec4 clip = reversed_projection(camera) * glm::vec4{p, 1.0F};
  return glm::vec3{clip} / clip.w;
}

TEST(Camera, DepthIsOneAtTheNearPlaneAndFallsToZero) {
  const Camera camera{.near_plane = 0.05};
  EXPECT_NEAR(projected(camera, {0, 0, -0.05F}).z, 1.0F, 1e-6F);
  EXPECT_GT(projected(camera, {0, 0, -10}).z, projected(camera, {0, 0, -11}).z);
  EXPECT_NEAR(projected(camera, {0, 0, -1e7F}).z, 0.0F, 1e-6F);
}

TEST(Camera, UpIsUpAndTheFieldOfViewIsVertical) {
  const Camera camera{.vertical_fov = std::numbers::pi / 2, .extent = {200, 100}};
  EXPECT_NEAR(projected(camera, {0, 3, -3}).y, -1.0F, 1e-6F) << "Vulkan's y points down";
  EXPECT_NEAR(projected(camera, {6, 0, -3}).x, 1.0F, 1e-6F);
}

TEST(Camera, ViewRotationTakesSceneAxesToTheCamera) {
  const Pose pose{.orientation = glm::angleAxis(std::numbers::pi / 2, glm::dvec3{0, 1, 0})};
  const glm::vec3 ahead = view_rotation(pose) * glm::vec3{-1, 0, 0};
  EXPECT_NEAR(ahead.z, -1.0F, 1e-6F) << "turned left, it looks along -X";
}

TEST(Camera, EnlargingKeepsTheResolutionInTheCentre) {
  const Camera camera{.vertical_fov = 1.2, .extent = {961, 541}};
  const Camera large = enlarged(camera, 1.2);
  EXPECT_EQ(large.extent, (Extent2D{1154, 650}));
  const auto focal = [](const Camera& c) { return c.extent.height / 2.0 / std::tan(c.vertical_fov / 2); };
  EXPECT_NEAR(focal(large), focal(camera), 1e-9);
}

TEST(Camera, PredictsAtEvenStepsBothEndsIncluded) {
  using std::chrono::milliseconds;
  const Pose now{.velocity = {1, 0, 0}};
  const auto x_of = [&](Duration cover, Duration step, std::uint32_t most) {
    std::vector<double> x;
    for (const Pose& p : predicted_poses(now, cover, step, most)) x.push_back(std::round(p.position.x * 1e6));
    return x;
  };
  EXPECT_EQ(x_of(milliseconds(100), milliseconds(50), 9), (std::vector<double>{0, 50'000, 100'000}));
  EXPECT_EQ(x_of(milliseconds(100), milliseconds(40), 9).size(), 4U) << "steps are at most 40 ms";
  EXPECT_EQ(x_of(milliseconds(100), milliseconds(10), 2), (std::vector<double>{0, 100'000}));
  EXPECT_EQ(x_of(milliseconds(100), milliseconds(10), 1), (std::vector<double>{0}));
  EXPECT_EQ(x_of(milliseconds(0), milliseconds(10), 4), (std::vector<double>{0}));
  EXPECT_EQ(x_of(milliseconds(-5), milliseconds(10), 4), (std::vector<double>{0}));
  EXPECT_EQ(x_of(milliseconds(4), milliseconds(0), 3).size(), 3U);
}

TEST(Frustum, SeesWhatMayBeInThePictureAndNothingBehind) {
  const RelativeCamera camera =
      relative_camera({.vertical_fov = std::numbers::pi / 2, .extent = {64, 64}}, {0, 0, 0});
  const auto box_at = [](const glm::vec3& p) { return Box{p - 0.5F, p + 0.5F}; };
  EXPECT_TRUE(may_see(camera, box_at({0, 0, -5})));
  EXPECT_TRUE(may_see(camera, box_at({5.4F, 0, -5}))) << "crosses an edge";
  EXPECT_TRUE(may_see(camera, box_at({0, 0, 0}))) << "around the camera";
  EXPECT_TRUE(may_see(camera, Box{glm::vec3{-100}, glm::vec3{100}}));
  EXPECT_FALSE(may_see(camera, box_at({0, 0, 5})));
  EXPECT_FALSE(may_see(camera, box_at({7, 0, -5})));
  EXPECT_FALSE(may_see(camera, box_at({0, -7, -5})));
}

}  // namespace
}  // namespace atlaswire::render
