#include "server/rate_fitter.h"

#include <algorithm>
#include <cmath>

namespace atlaswire::server {

namespace {

constexpr Duration::rep kWeight = 8;  ///< a new interval counts one in so many
constexpr double kDeadBand = 0.15;
constexpr double kMostFactor = 8;  ///< one frame may not get more than this many shares

}  // namespace

RateFitter::RateFitter(std::optional<BitRate> target, double nominal_fps)
    : target_(target), nominal_fps_(nominal_fps), interval_(from_seconds(1 / nominal_fps)) {}

void RateFitter::on_interval(Duration interval) {
  const Duration bounded = std::clamp(interval, Duration{0}, Duration{std::chrono::seconds(1)});
  interval_ += (bounded - interval_) / kWeight;
}

double RateFitter::wanted() const {
  const double factor = std::clamp(to_seconds(interval_) * nominal_fps_, 1.0, kMostFactor);
  return static_cast<double>(target_->bits_per_second) * factor;
}

std::optional<BitRate> RateFitter::take() {
  if (!target_) return std::nullopt;
  const double rate = wanted();
  if (told_ != 0 && std::abs(rate - told_) <= kDeadBand * told_) return std::nullopt;
  told_ = rate;
  return BitRate{static_cast<std::uint64_t>(rate)};
}

}  // namespace atlaswire::server
