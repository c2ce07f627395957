#include "render/warp/pixel_transfer.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

namespace atlaswire::render {
namespace {

/// Homogeneous pixel of a point in camera axes: (x, y, 1) times the distance along the view axis, which is
/// -Z.
glm::dmat3 pixel_from_camera(const Camera& camera) {
  const double half_width = camera.extent.width / 2.0;
  const double half_height = camera.extent.height / 2.0;
  const double focal = half_height / std::tan(camera.vertical_fov / 2);
  return glm::dmat3{focal, 0, 0, 0, -focal, 0, -half_width, -half_height, -1};
}

}  // namespace

PixelTransfer pixel_transfer(const Camera& from, const Camera& to) {
  const glm::dquat to_from_scene = glm::conjugate(glm::normalize(to.pose.orientation));
  const glm::dmat3 rotation = glm::mat3_cast(to_from_scene * glm::normalize(from.pose.orientation));
  const glm::dvec3 translation = to_from_scene * (from.pose.position - to.pose.position);
  const glm::dmat3 to_pixel = pixel_from_camera(to);
  return {.homography = to_pixel * rotation * glm::inverse(pixel_from_camera(from)),
          .parallax = to_pixel * translation};
}

}  // namespace atlaswire::render
