#pragma once

#include "base/random.h"
#include "netsim/link_profile.h"

#include <cstdint>

namespace atlaswire::netsim {

/// Draws delays of one DelayModel. A sequence is a function of model and seed.
class DelaySampler {
 public:
  explicit DelaySampler(std::uint64_t seed) : random_(seed) {}
  /// The delay at `now`, never negative. One normal draw for each call, or with `model.hold` for each first
  /// call of a stretch; whatever the shape, so that a profile step does not shift later draws.
  Duration next(const DelayModel& model, Time now = {});

 private:
  double draw(const DelayModel& model, Time now);

  Random random_;
  double previous_ = 0;
  std::int64_t stretch_ = -1;  ///< that previous_ was drawn for
  bool started_ = false;
};

/// Distribution function of the standard normal.
double normal_cdf(double x);

}  // namespace atlaswire::netsim
