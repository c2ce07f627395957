#include "server/intra_schedule.h"

namespace atlaswire::server {

bool IntraSchedule::next() {
  const bool by_rule = settings_.interval != 0 && since_ >= settings_.interval;
  const bool by_loss = loss_ && since_ >= settings_.loss_spacing;
  const bool by_memory = memory_ && since_ >= settings_.memory_spacing;
  if (!(at_once_ || by_rule || by_loss || by_memory)) {
    ++since_;
    return false;
  }
  at_once_ = loss_ = memory_ = false;
  since_ = 1;
  return true;
}

}  // namespace atlaswire::server
