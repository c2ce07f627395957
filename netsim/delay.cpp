#include "netsim/delay.h"

#include <algorithm>
#include <cmath>

namespace atlaswire::netsim {

namespace {

/// Lomax (Pareto II) above `base` with mean `spread`: scale = spread (alpha - 1).
double pareto_above_base(const DelayModel& model, double u) {
  const double scale = to_seconds(model.spread) * (model.pareto_alpha - 1);
  const double tail = std::max(1 - u, 0x1.0p-53);
  return scale * (std::pow(tail, -1 / model.pareto_alpha) - 1);
}

double empirical(const std::vector<Duration>& sorted, double u) {
  const double at = u * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  const double fraction = at - static_cast<double>(low);
  return to_seconds(sorted[low]) * (1 - fraction) + to_seconds(sorted[high]) * fraction;
}

}  // namespace

double normal_cdf(double x) { return 0.5 * std::erfc(-x * std::sqrt(0.5)); }

double DelaySampler::draw(const DelayModel& model, Time now) {
  if (model.hold > Duration::zero()) {
    const std::int64_t stretch = now.time_since_epoch() / model.hold;
    if (started_ && stretch == stretch_) return previous_;
    stretch_ = stretch;
  }
  const double fresh = random_.normal();
  const double rho = started_ ? model.correlation : 0;
  started_ = true;
  return previous_ = rho * previous_ + std::sqrt(1 - rho * rho) * fresh;
}

Duration DelaySampler::next(const DelayModel& model, Time now) {
  const double z = draw(model, now);
  double seconds = to_seconds(model.base);
  switch (model.shape) {
    case DelayModel::Shape::kConstant:
      break;
    case DelayModel::Shape::kUniform:
      seconds += to_seconds(model.spread) * (2 * normal_cdf(z) - 1);
      break;
    case DelayModel::Shape::kNormal:
      seconds += to_seconds(model.spread) * z;
      break;
    case DelayModel::Shape::kPareto:
      seconds += pareto_above_base(model, normal_cdf(z));
      break;
    case DelayModel::Shape::kEmpirical:
      seconds += empirical(model.samples, normal_cdf(z));
      break;
  }
  return std::clamp(from_seconds(seconds), Duration::zero(), model.most);
}

}  // namespace atlaswire::netsim
