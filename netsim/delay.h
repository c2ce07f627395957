#pragma once

#include "base/random.h"
#include "netsim/profile.h"

namespace atlaswire::netsim {

/// Draws delays of one DelayModel. A sequence is a function of model and seed.
class DelaySampler {
 public:
  explicit DelaySampler(std::uint64_t seed) : random_(seed) {}
  /// The next delay, never negative. One normal draw a call, whatever the shape, so that a profile step
  /// does not shift later draws.
  Duration next(const DelayModel& model);

 private:
  Random random_;
  double previous_ = 0;
  bool started_ = false;
};

/// Distribution function of the standard normal.
double normal_cdf(double x);

}  // namespace atlaswire::netsim
