#pragma once

#include "base/pose.h"
#include "base/time.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

namespace atlaswire::client {

/// A head tracker that plays a recorded motion in real time: asked by the network thread for poses to send
/// and by the display thread for poses to draw. Knows no pose until `set_motion`, holds the first one still
/// until `start`. Thread safe if the motion is.
class Tracker {
 public:
  using Motion = std::function<Pose(Duration)>;

  /// `motion`: the pose, with its velocities, at a time from the motion's start. Once.
  void set_motion(Motion motion);
  void start(Time now) { start_.store(to_nanos(now), std::memory_order_relaxed); }
  [[nodiscard]] std::optional<Pose> at(Time now) const;

 private:
  static constexpr std::int64_t kNotStarted = INT64_MIN;
  Motion motion_;
  std::atomic<bool> ready_{false};
  std::atomic<std::int64_t> start_{kNotStarted};
};

}  // namespace atlaswire::client
