#include "proto/refresh_timer.h"

#include <algorithm>

namespace atlaswire::proto {

bool RefreshTimer::poll(bool needs_refresh, Duration round_trip, Time now) {
  if (!needs_refresh) {
    next_.reset();
    return false;
  }
  if (next_ && now < *next_) return false;
  next_ = now + std::max(Duration(std::chrono::milliseconds(100)), 2 * round_trip);
  return true;
}

}  // namespace atlaswire::proto
