#pragma once

#include "base/time.h"

#include <cstddef>
#include <vector>

namespace atlaswire::client {

/// What is reported of a set of measurements; zeros when there are none.
struct Summary {
  std::size_t count = 0;
  double mean = 0;
  double p50 = 0;
  double p95 = 0;
  double p99 = 0;
  double smallest = 0;
  double largest = 0;
};

/// Measurements kept for percentiles, 8 octets each.
class Distribution {
 public:
  void add(double v) { values_.push_back(v); }
  /// In milliseconds.
  void add(Duration d) { add(to_ms(d)); }
  /// Percentiles by nearest rank.
  [[nodiscard]] Summary summary() const;
  [[nodiscard]] std::size_t count() const { return values_.size(); }

 private:
  std::vector<double> values_;
};

}  // namespace atlaswire::client
