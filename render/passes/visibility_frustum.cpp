#include "render/passes/visibility_frustum.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace atlaswire::render {

ViewVolume::ViewVolume(const Camera& camera, const glm::dvec3& scene_origin)
    : position_(camera.pose.position - scene_origin),
      camera_from_scene_(glm::transpose(glm::mat3_cast(glm::normalize(camera.pose.orientation)))),
      near_(camera.near_plane) {
  const double up = std::tan(camera.vertical_fov / 2);
  tangents_ = {up * camera.extent.width / camera.extent.height, up};
}

bool ViewVolume::may_see(const Box& box) const {
  const glm::dvec3 low(box.low);
  const glm::dvec3 high(box.high);
  const glm::dvec3 centre = camera_from_scene_ * ((low + high) * 0.5 - position_);
  const glm::dvec3 half = (high - low) * 0.5;
  // How far the box reaches from its centre along each camera axis, and so along any combination of two.
  const auto reach = [&](const glm::dvec3& direction) {
    const glm::dvec3 in_scene = glm::transpose(camera_from_scene_) * direction;
    return glm::dot(glm::abs(in_scene), half);
  };
  const auto outside = [&](const glm::dvec3& inward, double offset) {
    return glm::dot(inward, centre) + reach(inward) < offset;
  };
  if (outside({0, 0, -1}, near_)) return false;
  for (const double side : {-1.0, 1.0}) {
    if (outside({side, 0, -tangents_.x}, 0)) return false;
    if (outside({0, side, -tangents_.y}, 0)) return false;
  }
  return true;
}

}  // namespace atlaswire::render
