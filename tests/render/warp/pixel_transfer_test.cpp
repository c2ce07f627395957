#include "render/warp/pixel_transfer.h"

#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace atlaswire::render {
namespace {

Camera camera_at(const glm::dvec3& position, double yaw, Extent2D extent, double fov) {
  return {.pose = {.position = position, .orientation = glm::angleAxis(yaw, glm::dvec3{0, 1, 0})},
          .vertical_fov = fov,
          .extent = extent};
}

/// Pixel and distance along the axis of a scene point, by the renderer's own matrices.
glm::dvec3 seen(const Camera& camera, const glm::dvec3& point) {
  const glm::vec3 in_camera = view_rotation(camera.pose) * glm::vec3{point - camera.pose.position};
  const glm::dvec4 clip = glm::dmat4{reversed_projection(camera)} * glm::dvec4{in_camera, 1.0};
  return {(clip.x / clip.w + 1) / 2 * camera.extent.width, (clip.y / clip.w + 1) / 2 * camera.extent.height,
          clip.w};
}

TEST(PixelTransfer, OfOneCameraIsTheIdentity) {
  const Camera camera = camera_at({1e6, 2, 3}, 0.7, {96, 64}, 1.2);
  const PixelTransfer t = pixel_transfer(camera, camera);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) EXPECT_NEAR(t.homography[column][row], column == row ? 1 : 0, 1e-12);
    EXPECT_EQ(t.parallax[column], 0);
  }
}

TEST(PixelTransfer, PutsPointsWhereTheProjectionDoes) {
  const Camera from = camera_at({3, 1, -2}, 0.3, {96, 64}, 1.0);
  const Camera to = camera_at({3.2, 1.4, -2.3}, 0.1, {128, 120}, std::numbers::pi / 2);
  const PixelTransfer t = pixel_transfer(from, to);
  for (const glm::dvec3& point : {glm::dvec3{2, 1, -8}, glm::dvec3{1, 2.5, -5}, glm::dvec3{-40, 6, -90}}) {
    const glm::dvec3 a = seen(from, point);
    const glm::dvec3 b = seen(to, point);
    const glm::dvec3 h = t.homography * glm::dvec3{a.x, a.y, 1} + t.parallax / a.z;
    EXPECT_NEAR(h.x / h.z, b.x, 1e-3);
    EXPECT_NEAR(h.y / h.z, b.y, 1e-3);
    EXPECT_NEAR(h.z * a.z, b.z, 1e-4);
  }
}

}  // namespace
}  // namespace atlaswire::render
