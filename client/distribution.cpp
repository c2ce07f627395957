#include "client/distribution.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace atlaswire::client {

Summary Distribution::summary() const {
  if (values_.empty()) return {};
  std::vector<double> sorted = values_;
  std::ranges::sort(sorted);
  const auto rank = [&](double share) {
    const double n = std::ceil(share * static_cast<double>(sorted.size()));
    return sorted[std::max<std::size_t>(static_cast<std::size_t>(n), 1) - 1];
  };
  const double sum = std::accumulate(sorted.begin(), sorted.end(), 0.0);
  return {.count = sorted.size(),
          .mean = sum / static_cast<double>(sorted.size()),
          .p50 = rank(0.50),
          .p95 = rank(0.95),
          .p99 = rank(0.99),
          .smallest = sorted.front(),
          .largest = sorted.back()};
}

}  // namespace atlaswire::client
