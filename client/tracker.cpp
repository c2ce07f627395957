#include "client/tracker.h"

#include "base/assert.h"

#include <algorithm>
#include <utility>

namespace atlaswire::client {

void Tracker::set_motion(Motion motion) {
  AW_ASSERT(!ready_.load());
  motion_ = std::move(motion);
  ready_.store(true, std::memory_order_release);
}

std::optional<Pose> Tracker::at(Time now) const {
  if (!ready_.load(std::memory_order_acquire)) return std::nullopt;
  const std::int64_t start = start_.load(std::memory_order_relaxed);
  if (start != kNotStarted) return motion_(std::max(now - from_nanos(start), Duration{}));
  Pose pose = motion_(Duration{});
  pose.velocity = {};
  pose.angular_velocity = {};
  return pose;
}

}  // namespace atlaswire::client
