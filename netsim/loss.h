#pragma once

#include "base/random.h"
#include "netsim/link_profile.h"

namespace atlaswire::netsim {

/// Decides which packets the air loses; one decision a packet, in order of arrival.
class LossProcess {
 public:
  explicit LossProcess(std::uint64_t seed) : random_(seed) {}
  /// Is packet number `packet` lost? Two raw draws a call, whatever the kind.
  bool lose(const LossModel& model, std::uint64_t packet);

 private:
  bool gilbert_elliott(const LossModel& model, double move, double loss);
  bool four_state(const LossModel& model, double move);

  Random random_;
  bool bad_ = false;
  int state_ = 1;
};

/// Long-run loss share and mean length of loss runs of a Gilbert-Elliott chain with loss_good 0 and
/// loss_bad 1: p / (p + r), and 1 / r.
double gilbert_elliott_loss(const LossModel& model);

}  // namespace atlaswire::netsim
