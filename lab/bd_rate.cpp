#include "lab/bd_rate.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace atlaswire::lab {

namespace {

/// A curve sorted by log rate.
struct Curve {
  std::vector<double> log_rates;  ///< decadic
  std::vector<double> qualities;
};

Result<Curve> read_curve(std::span<const RatePoint> points, const char* name) {
  if (points.size() < 4) return Error{BdError::kTooFewPoints, name};
  std::vector<RatePoint> sorted(points.begin(), points.end());
  for (const RatePoint& p : sorted) {
    if (!(std::isfinite(p.rate) && p.rate > 0 && std::isfinite(p.quality))) {
      return Error{BdError::kBadPoint, name};
    }
  }
  std::sort(sorted.begin(), sorted.end(),
            [](const RatePoint& a, const RatePoint& b) { return a.rate < b.rate; });
  Curve curve;
  for (const RatePoint& p : sorted) {
    curve.log_rates.push_back(std::log10(p.rate));
    curve.qualities.push_back(p.quality);
  }
  return curve;
}

bool ascends(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
}

/// Mean of `test` less mean of `anchor`, as functions `value` of `argument`, where both are defined.
Result<double> mean_difference(std::span<const RatePoint> anchor, std::span<const RatePoint> test,
                               CurveFit fit, std::vector<double> Curve::*argument,
                               std::vector<double> Curve::*value) {
  const Result<Curve> a = read_curve(anchor, "anchor");
  if (!a) return a.error();
  const Result<Curve> t = read_curve(test, "test");
  if (!t) return t.error();
  const std::vector<double>& ax = (*a).*argument;
  const std::vector<double>& tx = (*t).*argument;
  if (!ascends(ax)) return Error{BdError::kNotMonotone, "anchor"};
  if (!ascends(tx)) return Error{BdError::kNotMonotone, "test"};
  const double from = std::max(ax.front(), tx.front());
  const double to = std::min(ax.back(), tx.back());
  if (!(from < to)) return Error{BdError::kNoOverlap, "anchor and test"};
  const double of_test = curve_integral(tx, (*t).*value, fit, from, to);
  const double of_anchor = curve_integral(ax, (*a).*value, fit, from, to);
  return (of_test - of_anchor) / (to - from);
}

}  // namespace

Result<double> bd_rate(std::span<const RatePoint> anchor, std::span<const RatePoint> test, CurveFit fit) {
  const Result<double> log_ratio = mean_difference(anchor, test, fit, &Curve::qualities, &Curve::log_rates);
  if (!log_ratio) return log_ratio.error();
  return 100 * (std::pow(10.0, *log_ratio) - 1);
}

Result<double> bd_quality(std::span<const RatePoint> anchor, std::span<const RatePoint> test, CurveFit fit) {
  return mean_difference(anchor, test, fit, &Curve::log_rates, &Curve::qualities);
}

const char* error_text(BdError e) {
  switch (e) {
    case BdError::kTooFewPoints:
      return "a rate-quality curve needs at least four points";
    case BdError::kBadPoint:
      return "rates must be positive, and rates and qualities finite";
    case BdError::kNotMonotone:
      return "quality must rise with rate, and no two points share a rate";
    case BdError::kNoOverlap:
      return "the curves have no common range";
  }
  return "unknown error of a rate difference";
}

}  // namespace atlaswire::lab
