#include "server/cover_estimator.h"

#include <algorithm>

namespace atlaswire::server {

namespace {

constexpr Duration::rep kWeight = 8;  ///< a new value counts one in so many

Duration blend(Duration old, Duration fresh) { return old + (fresh - old) / kWeight; }

}  // namespace

CoverEstimator::CoverEstimator(const CoverSettings& settings, Duration nominal_interval)
    : settings_(settings), interval_(nominal_interval) {}

void CoverEstimator::on_frame(Duration processing, Duration interval) {
  const Duration bounded = std::min(processing, settings_.most);
  processing_ = measured_ ? blend(processing_, bounded) : bounded;
  interval_ = blend(interval_, std::min(interval, settings_.most));
  measured_ = true;
}

void CoverEstimator::on_sending(Duration sending) {
  sending_ = blend(sending_, std::min(sending, settings_.most));
}

Duration CoverEstimator::cover() const {
  if (settings_.fixed) return *settings_.fixed;
  return std::clamp(round_trip_ + processing_ + sending_ + interval_ + settings_.allowance, Duration{0},
                    settings_.most);
}

Duration CoverEstimator::display_delay(Duration waited) const {
  return std::max(cover() - round_trip_ / 2 - waited - interval_ / 2, Duration::zero());
}

}  // namespace atlaswire::server
