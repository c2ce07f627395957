#include "netsim/aqm.h"

#include <algorithm>
#include <cmath>

namespace atlaswire::netsim {

namespace {

constexpr std::uint64_t kMtu = 1514;

/// RFC 8289 5.4: the next drop comes interval / sqrt(count) later.
Time control_law(Time t, const QueueModel& model, std::uint32_t count) {
  return t + from_seconds(to_seconds(model.interval) / std::sqrt(static_cast<double>(count)));
}

}  // namespace

bool Codel::above_target(const QueueModel& model, Duration sojourn, std::uint64_t backlog, Time now) {
  if (sojourn < model.target || backlog <= kMtu) {
    timing_ = false;
    return false;
  }
  if (!timing_) {
    timing_ = true;
    first_above_ = now + model.interval;
    return false;
  }
  return now >= first_above_;
}

bool Codel::drop(const QueueModel& model, Duration sojourn, std::uint64_t backlog, Time now) {
  const bool ok_to_drop = above_target(model, sojourn, backlog, now);
  if (dropping_) {
    if (!ok_to_drop) {
      dropping_ = false;
      return false;
    }
    if (now < drop_next_) return false;
    ++count_;
    drop_next_ = control_law(drop_next_, model, count_);
    return true;
  }
  if (!ok_to_drop) return false;
  dropping_ = true;
  const std::uint32_t delta = count_ - last_count_;
  const bool recent = now - drop_next_ < 16 * model.interval;
  count_ = delta > 1 && recent ? delta : 1;
  drop_next_ = control_law(now, model, count_);
  last_count_ = count_;
  return true;
}

void Pie::update(const QueueModel& model, Duration queue_delay) {
  constexpr double kAlpha = 0.125;  // per second
  constexpr double kBeta = 1.25;
  double change =
      kAlpha * to_seconds(queue_delay - model.target) + kBeta * to_seconds(queue_delay - old_delay_);
  constexpr struct {
    double below;
    double scale;
  } kTuning[] = {{1e-6, 1.0 / 2048}, {1e-5, 1.0 / 512}, {1e-4, 1.0 / 128},
                 {1e-3, 1.0 / 32},   {1e-2, 1.0 / 8},   {1e-1, 1.0 / 2}};
  for (const auto& step : kTuning) {
    if (probability_ < step.below) {
      change *= step.scale;
      break;
    }
  }
  if (probability_ >= 0.1) change = std::min(change, 0.02);
  probability_ += change;
  if (queue_delay == Duration::zero() && old_delay_ == Duration::zero()) probability_ *= 0.98;
  probability_ = std::clamp(probability_, 0.0, 1.0);
  old_delay_ = queue_delay;
  burst_allowance_ = std::max(Duration::zero(), burst_allowance_ - kUpdatePeriod);
  if (probability_ == 0 && queue_delay < model.target / 2 && old_delay_ < model.target / 2) {
    burst_allowance_ = std::chrono::milliseconds(150);
  }
}

bool Pie::settled() const {
  return probability_ == 0 && old_delay_ == Duration::zero() &&
         burst_allowance_ == std::chrono::milliseconds(150);
}

bool Pie::drop(const QueueModel& model, std::uint64_t backlog, Duration queue_delay) {
  const double draw = random_.uniform();
  if (burst_allowance_ > Duration::zero()) return false;
  if (queue_delay < model.target / 2 && old_delay_ < model.target / 2 && probability_ < 0.2) return false;
  if (backlog <= 2 * kMtu) return false;
  return draw < probability_;
}

}  // namespace atlaswire::netsim
