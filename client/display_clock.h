#pragma once

#include "base/time.h"

#include <algorithm>

namespace atlaswire::client {

/// When displayed frames start: every 1/rate seconds from the first, like a display's refresh. A frame
/// that takes too long misses refreshes; they are not caught up. Pure.
class DisplayClock {
 public:
  /// `rate` in Hz; 0: as soon as the last frame is done.
  explicit DisplayClock(double rate) : interval_(rate > 0 ? from_seconds(1 / rate) : Duration{}) {}

  /// The start of the next frame, not before `now`.
  Time next(Time now) {
    if (interval_ == Duration{}) return now;
    if (last_ == Time{}) {
      last_ = now;
    } else {
      const auto behind = (now - last_ + interval_ - Duration{1}) / interval_;  // refreshes, rounded up
      last_ += std::max<Duration::rep>(behind, 1) * interval_;
    }
    return last_;
  }

 private:
  Duration interval_;
  Time last_{};
};

}  // namespace atlaswire::client
