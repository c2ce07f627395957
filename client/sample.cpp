#include "client/sample.h"

namespace atlaswire::client {

SampleSchedule::SampleSchedule(std::uint32_t count, Duration warm_up, Duration duration)
    : count_(count),
      first_(warm_up),
      step_(duration == Duration{} ? Duration{std::chrono::seconds(1)}
                                   : (duration - warm_up) / (count > 0 ? count : 1)) {
  first_ += step_ / 2;
}

bool SampleSchedule::take(Duration since_start) {
  if (taken_ == count_ || since_start < first_ + taken_ * step_) return false;
  ++taken_;
  return true;
}

}  // namespace atlaswire::client
