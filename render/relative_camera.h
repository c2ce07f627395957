#pragma once

#include "render/camera.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace atlaswire::render {

/// A camera for geometry whose float positions are relative to an origin in double: shaders subtract `high`
/// and then `low` before the matrix, so that nothing is lost however far the origin is away.
struct RelativeCamera {
  glm::mat4 clip_from_relative{1.0F};  ///< projection times rotation
  glm::vec4 high{0.0F};                ///< camera minus origin, rounded to float
  glm::vec4 low{0.0F};                 ///< what that rounding lost
};

/// A point relative to an origin, in two floats a component.
inline void split(const glm::dvec3& relative, glm::vec4& high, glm::vec4& low) {
  const glm::vec3 rounded{relative};
  high = {rounded, 0.0F};
  low = {glm::vec3{relative - glm::dvec3{rounded}}, 0.0F};
}

inline RelativeCamera relative_camera(const Camera& camera, const glm::dvec3& origin) {
  RelativeCamera r;
  r.clip_from_relative = reversed_projection(camera) * glm::mat4{view_rotation(camera.pose)};
  split(camera.pose.position - origin, r.high, r.low);
  return r;
}

}  // namespace atlaswire::render
