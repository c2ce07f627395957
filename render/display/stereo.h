#pragma once

#include "render/camera.h"

#include <cstdint>

namespace atlaswire::render {

enum class Eye : std::uint8_t { kLeft, kRight };

/// The camera of one eye of a head ([SAS] 3.6: "a statically calibrated offset for left and right eye"): half
/// of the distance between the eyes, `ipd` in metres, to its side, looking the same way as the head.
inline Camera eye_camera(const Camera& head, Eye eye, double ipd) {
  Camera camera = head;
  camera.pose = eye_pose(head.pose, eye == Eye::kLeft ? -ipd / 2 : ipd / 2);
  return camera;
}

}  // namespace atlaswire::render
