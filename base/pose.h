#pragma once

#include "base/ids.h"
#include "base/time.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace atlaswire {

/// Where a viewer is and how it moves. Metres, scene axes (+Y up); the camera looks down its own -Z.
struct Pose {
  glm::dvec3 position{0.0};
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  ///< unit; camera to scene
  glm::dvec3 velocity{0.0};                    ///< m/s, scene axes
  glm::dvec3 angular_velocity{0.0};            ///< rad/s, scene axes, right-handed
};

/// A pose as a client sent it: its number and the client's time of sampling.
struct StampedPose {
  PoseId id{};
  Time sampled{};
  Pose pose;
};

/// Linear motion prediction ([SAS] 3.1): position moves by velocity, orientation turns about the angular
/// velocity's axis; velocities stay. `ahead` may be negative.
Pose extrapolate(const Pose& pose, Duration ahead);

/// Between two poses, `t` in [0, 1]: linear positions and velocities, shortest-arc slerp.
Pose interpolate(const Pose& a, const Pose& b, double t);

/// Velocities of the motion that takes `a` to `b` in `elapsed`; zero when `elapsed` is not positive.
void set_velocities_from(const Pose& a, Pose& b, Duration elapsed);

/// Every component finite, the quaternion's norm within 1e-3 of 1, positions within 1e9 m, velocities
/// within 1e4: what a receiver demands of a peer's pose.
bool is_sane(const Pose& pose);

}  // namespace atlaswire
