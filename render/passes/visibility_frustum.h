#pragma once

#include "render/camera.h"
#include "render/scene/scene.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace atlaswire::render {

/// What a camera can see: the pyramid in front of its near plane, without end. In double and relative to
/// the camera, so that distant cameras and scenes lose nothing.
class ViewVolume {
 public:
  /// `scene_origin`: what boxes are relative to.
  ViewVolume(const Camera& camera, const glm::dvec3& scene_origin);

  /// False only if no point of the box is inside; near an edge it may be true for a box just outside.
  [[nodiscard]] bool may_see(const Box& box) const;

 private:
  glm::dvec3 position_;           ///< of the camera, relative to the scene's origin
  glm::dmat3 camera_from_scene_;  ///< rotation
  glm::dvec2 tangents_;           ///< of half the field of view, across and up
  double near_;
};

}  // namespace atlaswire::render
