#include "lab/bd_rate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace atlaswire::lab {
namespace {

constexpr CurveFit kFits[] = {CurveFit::kCubic, CurveFit::kPchip, CurveFit::kAkima};

std::vector<RatePoint> scaled(std::vector<RatePoint> curve, double rate, double quality) {
  for (RatePoint& p : curve) p = {p.rate * rate, p.quality + quality};
  return curve;
}

const std::vector<RatePoint> kCurve{{1000, 31.2}, {2100, 34.0}, {4300, 36.9}, {8000, 39.1}, {16000, 41.0}};

TEST(BdRate, FindsAConstantRatio) {
  for (const CurveFit fit : kFits) {
    EXPECT_NEAR(bd_rate(kCurve, kCurve, fit).value(), 0, 1e-9);
    EXPECT_NEAR(bd_rate(kCurve, scaled(kCurve, 0.8, 0), fit).value(), -20, 1e-9);
    EXPECT_NEAR(bd_rate(kCurve, scaled(kCurve, 3, 0), fit).value(), 200, 1e-9);
    EXPECT_NEAR(bd_quality(kCurve, scaled(kCurve, 1, 1.5), fit).value(), 1.5, 1e-9);
  }
}

// Quality = 10 log10(rate) + c is a straight line, which all fits reproduce: an offset of 1 is a rate ratio
// of 10^-0.1, on whatever range the curves overlap.
TEST(BdRate, MatchesTheClosedFormOnStraightLines) {
  std::vector<RatePoint> anchor;
  std::vector<RatePoint> test;
  for (const double rate : {1.0, 2.5, 4.0, 11.0, 20.0}) anchor.push_back({rate, 10 * std::log10(rate)});
  for (const double rate : {3.0, 5.0, 8.0, 40.0}) test.push_back({rate, 10 * std::log10(rate) + 1});
  for (const CurveFit fit : kFits) {
    EXPECT_NEAR(bd_rate(anchor, test, fit).value(), 100 * (std::pow(10, -0.1) - 1), 1e-6);
    EXPECT_NEAR(bd_quality(anchor, test, fit).value(), 1, 1e-9);
  }
}

TEST(BdRate, TakesPointsInAnyOrderAndAnyUnit) {
  const std::vector<RatePoint> test = scaled(kCurve, 0.9, 0.3);
  std::vector<RatePoint> shuffled{test[3], test[0], test[4], test[2], test[1]};
  for (const CurveFit fit : kFits) {
    const double expected = bd_rate(kCurve, test, fit).value();
    EXPECT_LT(expected, -10);
    EXPECT_EQ(bd_rate(kCurve, shuffled, fit).value(), expected);
    EXPECT_NEAR(bd_rate(scaled(kCurve, 1e-6, 0), scaled(test, 1e-6, 0), fit).value(), expected, 1e-9);
  }
}

TEST(BdRate, IsReciprocalWhenCurvesAreExchanged) {
  const std::vector<RatePoint> test{{900, 31.0}, {2000, 34.5}, {4100, 37.0}, {8200, 39.8}};
  for (const CurveFit fit : kFits) {
    const double there = 1 + bd_rate(kCurve, test, fit).value() / 100;
    const double back = 1 + bd_rate(test, kCurve, fit).value() / 100;
    EXPECT_NEAR(there * back, 1, 1e-12);
    EXPECT_NEAR(bd_quality(kCurve, test, fit).value(), -bd_quality(test, kCurve, fit).value(), 1e-12);
  }
}

TEST(BdRate, PchipDoesNotOvershootASaturatingCurve) {
  const std::vector<RatePoint> steep{{1, 0.1}, {2, 0.9}, {4, 0.91}, {8, 0.92}};
  const std::vector<double> x{0, 1, 2, 3};
  const std::vector<double> y{0.1, 0.9, 0.91, 0.92};
  EXPECT_LE(curve_integral(x, y, CurveFit::kPchip, 1, 2), 0.91);
  EXPECT_GE(curve_integral(x, y, CurveFit::kPchip, 1, 2), 0.9);
  EXPECT_GT(curve_integral(x, y, CurveFit::kCubic, 1, 2), 0.93);  // which is why pchip exists
  EXPECT_NEAR(bd_rate(steep, scaled(steep, 2, 0), CurveFit::kPchip).value(), 100, 1e-9);
}

TEST(BdRate, RefusesWhatHasNoDifference) {
  const auto code = [](const Result<double>& result) { return result.error().code; };
  const std::vector<RatePoint> three{kCurve.begin(), kCurve.begin() + 3};
  EXPECT_EQ(code(bd_rate(three, kCurve)), make_error_code(BdError::kTooFewPoints));
  EXPECT_EQ(bd_rate(kCurve, three).error().detail, "test");
  EXPECT_EQ(code(bd_quality({}, {})), make_error_code(BdError::kTooFewPoints));
  for (const RatePoint bad : {RatePoint{0, 40}, RatePoint{-1, 40}, RatePoint{std::nan(""), 40},
                              RatePoint{1, std::numeric_limits<double>::infinity()}}) {
    std::vector<RatePoint> curve = kCurve;
    curve[2] = bad;
    EXPECT_EQ(code(bd_rate(curve, kCurve)), make_error_code(BdError::kBadPoint));
  }
  std::vector<RatePoint> sagging = kCurve;
  sagging[3].quality = 36.0;
  EXPECT_EQ(code(bd_rate(kCurve, sagging)), make_error_code(BdError::kNotMonotone));
  EXPECT_TRUE(bd_quality(kCurve, sagging).has_value());
  std::vector<RatePoint> repeated = kCurve;
  repeated[3].rate = repeated[2].rate;
  EXPECT_EQ(code(bd_quality(kCurve, repeated)), make_error_code(BdError::kNotMonotone));
  EXPECT_EQ(code(bd_rate(kCurve, scaled(kCurve, 1, 20))), make_error_code(BdError::kNoOverlap));
  EXPECT_EQ(code(bd_quality(kCurve, scaled(kCurve, 16, 0))), make_error_code(BdError::kNoOverlap));
}

}  // namespace
}  // namespace atlaswire::lab
