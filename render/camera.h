#pragma once

#include "base/pose.h"
#include "base/units.h"

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <vector>

namespace atlaswire::render {

/// A pinhole view: what a display of `extent` pixels with a vertical field of view sees from a pose.
struct Camera {
  Pose pose;
  double vertical_fov = 1.0471975511965976;  ///< radians, (0, pi)
  Extent2D extent{960, 540};
  double near_plane = 0.05;  ///< metres, > 0; there is no far plane
};

/// Reversed-Z projection with the far plane at infinity: depth 1 at the near plane, 0 at infinity. Vulkan
/// clip space (y down).
glm::mat4 reversed_projection(const Camera& camera);

/// Rotation from scene to camera axes; positions are made camera-relative in double before it.
glm::mat3 view_rotation(const Pose& pose);

/// The camera whose picture is `scale` times wider and higher at the same resolution in its centre
/// ([SAS] 5: "enlarge the FOV by 20%"): tangents and extents grow by `scale`; sides are rounded up to even.
Camera enlarged(const Camera& camera, double scale);

/// The pose of an eye `offset` metres to the right of `head`, looking the same way.
Pose eye_pose(const Pose& head, double offset);

/// The poses whose visible sets are united ([SAS] 3.1): now, then linear predictions at equal steps of at
/// most `step` up to `cover`, both ends included; just now when `cover` is not positive. At most
/// `max_views` of them, steps stretched to fit.
std::vector<Pose> predicted_poses(const Pose& now, Duration cover, Duration step, std::uint32_t max_views);

}  // namespace atlaswire::render
