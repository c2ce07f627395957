#include "render/camera.h"

#include "base/assert.h"

#include <algorithm>
#include <cmath>

namespace atlaswire::render {

glm::mat4 reversed_projection(const Camera& camera) {
  const double focal = 1.0 / std::tan(camera.vertical_fov / 2);
  const double aspect = static_cast<double>(camera.extent.width) / static_cast<double>(camera.extent.height);
  glm::mat4 m{0.0F};
  m[0][0] = static_cast<float>(focal / aspect);
  m[1][1] = static_cast<float>(-focal);
  m[2][3] = -1.0F;
  m[3][2] = static_cast<float>(camera.near_plane);
  return m;
}

glm::mat3 view_rotation(const Pose& pose) {
  return glm::mat3{glm::mat3_cast(glm::conjugate(glm::normalize(pose.orientation)))};
}

Camera enlarged(const Camera& camera, double scale) {
  const auto side = [&](std::uint32_t pixels) {
    const auto grown = static_cast<std::uint32_t>(std::ceil(pixels * scale - 1e-9));
    return grown + grown % 2;
  };
  Camera large = camera;
  large.extent = {side(camera.extent.width), side(camera.extent.height)};
  // Rounding a side up must not change the resolution in the centre: the field of view follows the pixels.
  large.vertical_fov = 2 * std::atan(std::tan(camera.vertical_fov / 2) * large.extent.height /
                                     std::max(camera.extent.height, 1U));
  return large;
}

Pose eye_pose(const Pose& head, double offset) {
  Pose eye = head;
  eye.position += head.orientation * glm::dvec3{offset, 0, 0};
  return eye;
}

std::vector<Pose> predicted_poses(const Pose& now, Duration cover, Duration step, std::uint32_t max_views) {
  AW_ASSERT(max_views >= 1);
  std::vector<Pose> poses{now};
  if (cover <= Duration::zero() || max_views == 1) return poses;
  const auto fine = std::max(step, Duration{1});
  const auto wanted = static_cast<std::uint64_t>((cover + fine - Duration{1}) / fine);
  const std::uint64_t steps = std::min<std::uint64_t>(wanted, max_views - 1);
  for (std::uint64_t i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(steps);
    poses.push_back(extrapolate(now, from_seconds(to_seconds(cover) * share)));
  }
  return poses;
}

}  // namespace atlaswire::render
