#pragma once

#include "base/time.h"

#include <optional>

namespace atlaswire::proto {

/// Client: when to send a PLI. At once when a refresh is needed, then again every 100 ms (every two round
/// trips, where that is longer) for as long as it is.
class RefreshTimer {
 public:
  /// True when a PLI should go out now.
  bool poll(bool needs_refresh, Duration round_trip, Time now);
  /// When to ask again; nullopt when nothing is needed.
  [[nodiscard]] std::optional<Time> next_deadline() const { return next_; }

 private:
  std::optional<Time> next_;
};

}  // namespace atlaswire::proto
