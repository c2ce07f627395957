#include "netsim/delay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace atlaswire::netsim {
namespace {

using std::chrono::milliseconds;
constexpr int kDraws = 200'000;

struct Moments {
  double mean = 0;
  double variance = 0;
  double lag_correlation = 0;
};

std::vector<double> draw(const DelayModel& model, std::uint64_t seed) {
  DelaySampler sampler(seed);
  std::vector<double> out;
  for (int i = 0; i < kDraws; ++i) out.push_back(to_ms(sampler.next(model)));
  return out;
}

Moments moments(const std::vector<double>& x) {
  Moments m;
  const auto n = static_cast<double>(x.size());
  for (const double v : x) m.mean += v / n;
  for (const double v : x) m.variance += (v - m.mean) * (v - m.mean) / n;
  for (std::size_t i = 1; i < x.size(); ++i) m.lag_correlation += (x[i] - m.mean) * (x[i - 1] - m.mean) / n;
  m.lag_correlation /= m.variance;
  return m;
}

/// Five standard errors of a mean of kDraws draws: seeds are fixed, so this can fail only by a wrong model.
double mean_bound(double deviation) { return 5 * deviation / std::sqrt(double{kDraws}); }

TEST(DelaySampler, ConstantIsConstant) {
  DelayModel model;
  model.base = milliseconds(7);
  for (const double ms : draw(model, 1)) ASSERT_EQ(ms, 7.0);
}

TEST(DelaySampler, UniformHasItsMomentsAndBounds) {
  DelayModel model{.shape = DelayModel::Shape::kUniform, .base = milliseconds(20), .spread = milliseconds(6)};
  const auto x = draw(model, 2);
  const Moments m = moments(x);
  EXPECT_NEAR(m.mean, 20, mean_bound(6 / std::sqrt(3.0)));
  EXPECT_NEAR(m.variance, 12, 5 * 12 * std::sqrt(0.8 / kDraws));  // kurtosis 1.8
  for (const double v : x) ASSERT_TRUE(v >= 14 && v <= 26);
}

TEST(DelaySampler, NormalHasItsMomentsAndCorrelation) {
  DelayModel model{.shape = DelayModel::Shape::kNormal, .base = milliseconds(50), .spread = milliseconds(5)};
  model.correlation = 0.7;
  const Moments m = moments(draw(model, 3));
  const double inflation = std::sqrt((1 + 0.7) / (1 - 0.7));
  EXPECT_NEAR(m.mean, 50, inflation * mean_bound(5));
  EXPECT_NEAR(m.variance, 25, 5 * 25 * std::sqrt(2.0 / kDraws * (1 + 0.49) / (1 - 0.49)));
  EXPECT_NEAR(m.lag_correlation, 0.7, 5 * std::sqrt((1 - 0.49) / kDraws));
}

TEST(DelaySampler, CorrelationKeepsTheShape) {
  DelayModel model{.shape = DelayModel::Shape::kUniform, .base = milliseconds(20), .spread = milliseconds(6)};
  model.correlation = 0.9;
  const Moments m = moments(draw(model, 4));
  EXPECT_NEAR(m.variance, 12, 5 * 12 * std::sqrt(0.8 / kDraws * (1 + 0.81) / (1 - 0.81)));
}

TEST(DelaySampler, ParetoHasItsMeanAndQuantiles) {
  DelayModel model{.shape = DelayModel::Shape::kPareto, .base = milliseconds(10), .spread = milliseconds(4)};
  model.pareto_alpha = 4;
  const auto x = draw(model, 5);
  const double scale = 4.0 * 3;  // mean above base = scale / (alpha - 1)
  const double deviation = scale / 3 * std::sqrt(4.0 / 2);
  EXPECT_NEAR(moments(x).mean, 14, mean_bound(deviation));
  const double median = 10 + scale * (std::pow(0.5, -0.25) - 1);
  int below = 0;
  for (const double v : x) below += v < median ? 1 : 0;
  EXPECT_NEAR(below / double{kDraws}, 0.5, mean_bound(0.5));
}

TEST(DelaySampler, EmpiricalInterpolatesItsSamples) {
  DelayModel model{.shape = DelayModel::Shape::kEmpirical};
  model.samples = {milliseconds(10), milliseconds(20), milliseconds(60)};
  const auto x = draw(model, 6);
  const double mean = 0.5 * 15 + 0.5 * 40;
  const double second = 0.5 * (225 + 100.0 / 12) + 0.5 * (1600 + 1600.0 / 12);
  EXPECT_NEAR(moments(x).mean, mean, mean_bound(std::sqrt(second - mean * mean)));
}

TEST(DelaySampler, NeverNegative) {
  DelayModel model{.shape = DelayModel::Shape::kNormal, .base = milliseconds(1), .spread = milliseconds(50)};
  for (const double v : draw(model, 7)) ASSERT_GE(v, 0);
}

TEST(DelaySampler, AHeldDrawIsAFunctionOfTimeAndNotOfThePacketRate) {
  DelayModel model{.shape = DelayModel::Shape::kPareto,
                   .base = std::chrono::milliseconds(3),
                   .spread = std::chrono::milliseconds(6),
                   .pareto_alpha = 2.2,
                   .correlation = 0.5,
                   .hold = std::chrono::milliseconds(20)};
  DelaySampler busy(9);
  DelaySampler quiet(9);
  for (int ms = 0; ms < 2000; ++ms) {
    const Time now{std::chrono::milliseconds(ms)};
    const Duration delay = busy.next(model, now);
    EXPECT_EQ(busy.next(model, now), delay);
    if (ms % 20 == 7) {
      EXPECT_EQ(quiet.next(model, now), delay) << ms;
    }
  }
}

TEST(DelaySampler, NoDrawExceedsTheMost) {
  DelayModel model{.shape = DelayModel::Shape::kPareto,
                   .spread = std::chrono::milliseconds(6),
                   .pareto_alpha = 1.5,
                   .most = std::chrono::milliseconds(40)};
  DelaySampler sampler(2);
  Duration longest{};
  for (int i = 0; i < 10'000; ++i) longest = std::max(longest, sampler.next(model));
  EXPECT_EQ(longest, std::chrono::milliseconds(40)) << "P(one draw beyond) is 2 %";
}

}  // namespace
}  // namespace atlaswire::netsim
