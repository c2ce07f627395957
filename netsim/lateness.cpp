#include "netsim/lateness.h"

#include <algorithm>
#include <cmath>

namespace atlaswire::netsim {

void Lateness::add(Time due, Time done) {
  const Duration late = std::max(Duration::zero(), done - due);
  const auto us = static_cast<std::size_t>((late.count() + 999) / 1000);
  ++bins_[std::min(us, kBins - 1)];
  ++count_;
  most_ = std::max(most_, late);
}

double Lateness::quantile_us(double q) const {
  const double wanted = std::ceil(q * static_cast<double>(count_));
  double below = 0;
  for (std::size_t us = 0; us < kBins; ++us) {
    below += static_cast<double>(bins_[us]);
    if (count_ > 0 && below >= wanted) return static_cast<double>(us);
  }
  return 0;
}

}  // namespace atlaswire::netsim
