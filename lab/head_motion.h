#pragma once

#include "base/pose.h"
#include "base/time.h"
#include "render/scene/camera_path.h"

namespace atlaswire::lab {

/// A head that follows a path, as its tracker reports it: velocities come from the newest sample and the one
/// before it, so that no prediction knows the future ([SAS] 5: "the two most recent view matrices").
class HeadMotion {
 public:
  /// `sample_interval`: between the tracker's samples, > 0.
  HeadMotion(render::CameraPath path, Duration sample_interval)
      : path_(std::move(path)), sample_interval_(sample_interval) {}

  /// At a time since the path's start, which may be negative.
  [[nodiscard]] Pose at(Duration time) const {
    Pose pose = path_.at(time);
    set_velocities_from(path_.at(time - sample_interval_), pose, sample_interval_);
    return pose;
  }

 private:
  render::CameraPath path_;
  Duration sample_interval_;
};

}  // namespace atlaswire::lab
