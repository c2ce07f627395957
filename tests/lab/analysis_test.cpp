#include "lab/analysis.h"

#include <gtest/gtest.h>

#include <cmath>

namespace atlaswire::lab {
namespace {

/// Rows of an experiment with variants "ours" and "ATW" over latency and bit rate.
class Rows {
 public:
  void add(const std::string& variant, double latency, double mbps, double mssim, double ms = 1) {
    Row r;
    r.point.id = "p" + std::to_string(rows_.size());
    r.point.variant = variant;
    r.point.settings.method = variant == "ours" ? "sas" : "atw";
    r.point.settings.latency_ms = latency;
    r.record.result.figures = {{"mssim", mssim}, {"total_mbps", mbps}};
    r.record.result.timings = {{"server_frame_ms", ms}};
    rows_.push_back(std::move(r));
  }
  [[nodiscard]] Analysis analyse(std::string_view rules) const {
    const auto e =
        parse_experiment(std::string("name = \"t\"\n[[variant]]\nname = \"ours\"\nmethod = \"sas\"\n"
                                     "[[variant]]\nname = \"ATW\"\nmethod = \"atw\"\n") +
                             std::string(rules),
                         "t");
    std::vector<PlannedPoint> points;
    for (const Row& r : rows_) points.push_back(r.point);
    return lab::analyse(*e, plan_of(std::move(points)), rows_);
  }

 private:
  std::vector<Row> rows_;
};

constexpr const char* kCrossover = "[crossover]\nx = \"latency_ms\"\ny = \"mssim\"\nreference = \"ours\"\n";

TEST(Analysis, CrossoversAreInterpolated) {
  Rows rows;
  for (const auto& [latency, ours, atw] :
       {std::tuple(0, 0.90, 0.96), {20, 0.90, 0.90 + 0.02}, {40, 0.90, 0.86}}) {
    rows.add("ours", latency, 10, ours);
    rows.add("ATW", latency, 10, atw);
  }
  const Analysis a = rows.analyse(kCrossover);
  ASSERT_EQ(a.crossovers.size(), 1U);
  EXPECT_EQ(a.crossovers[0].variant, "ATW");
  EXPECT_FALSE(a.crossovers[0].reference_first);
  ASSERT_EQ(a.crossovers[0].at.size(), 1U);
  EXPECT_NEAR(a.crossovers[0].at[0].x, 20 + 20.0 / 3, 1e-9);
  EXPECT_TRUE(a.crossovers[0].at[0].rises);
}

TEST(Analysis, CurvesThatNeverMeetHaveNoCrossover) {
  Rows rows;
  for (const double latency : {0.0, 20.0}) {
    rows.add("ours", latency, 10, 0.9);
    rows.add("ATW", latency, 10, 0.8);
  }
  const Analysis a = rows.analyse(kCrossover);
  ASSERT_EQ(a.crossovers.size(), 1U);
  EXPECT_TRUE(a.crossovers[0].reference_first);
  EXPECT_TRUE(a.crossovers[0].at.empty());
}

TEST(Analysis, HalfTheBytesForTheSameQualityAreMinusFiftyPercent) {
  Rows rows;
  for (const double mbps : {5.0, 10.0, 20.0, 40.0}) {
    rows.add("ours", 0, mbps, 0.7 + 0.05 * std::log2(mbps));
    rows.add("ATW", 0, mbps / 2, 0.7 + 0.05 * std::log2(mbps));
  }
  const Analysis a =
      rows.analyse("[rate]\nrate = \"total_mbps\"\nquality = \"mssim\"\nreference = \"ours\"\n");
  ASSERT_EQ(a.rates.size(), 1U);
  EXPECT_NEAR(a.rates[0].rate_percent, -50, 0.1);
  EXPECT_NEAR(a.rates[0].quality, 0.05, 1e-3);
  EXPECT_TRUE(a.rates[0].why.empty());
}

TEST(Analysis, RatesSayWhyThereIsNoFigure) {
  Rows rows;
  rows.add("ours", 0, 5, 0.8);
  rows.add("ATW", 0, 5, 0.8);
  const Analysis a =
      rows.analyse("[rate]\nrate = \"total_mbps\"\nquality = \"mssim\"\nreference = \"ours\"\n");
  ASSERT_EQ(a.rates.size(), 1U);
  EXPECT_TRUE(std::isnan(a.rates[0].rate_percent));
  EXPECT_FALSE(a.rates[0].why.empty());
}

TEST(Analysis, DifferencesStandBesideTheReferenceOfTheirGroup) {
  Rows rows;
  rows.add("ATW", 0, 10, 0.96);
  rows.add("ours", 0, 10, 0.90);
  rows.add("ours", 50, 10, 0.89);
  rows.add("ATW", 50, 10, 0.70);
  rows.add("ATW", 90, 10, 0.60);  // without a reference
  const Analysis a = rows.analyse("[difference]\ny = [\"mssim\"]\nreference = \"ours\"\n");
  ASSERT_EQ(a.differences.size(), 4U);
  EXPECT_EQ(a.differences[0].variant, "ours");
  EXPECT_EQ(a.differences[0].group, "latency_ms 0");
  EXPECT_EQ(a.differences[0].more, 0);
  EXPECT_NEAR(a.differences[1].more, 0.06, 1e-12);
  EXPECT_EQ(a.differences[3].group, "latency_ms 50");
  EXPECT_NEAR(a.differences[3].more, -0.19, 1e-12);
}

constexpr const char* kPareto = R"([pareto]
most = "mssim"
least = ["total_mbps", "server_frame_ms"]
[[recommend]]
client = "phone"
best = "mssim"
at_most = { total_mbps = 10 }
[[recommend]]
client = "telegraph"
best = "mssim"
at_most = { total_mbps = 0.001 }
)";

TEST(Analysis, TheFrontHoldsWhatNothingBeats) {
  Rows rows;
  rows.add("ours", 0, 10, 0.90, 5);  // p0
  rows.add("ours", 1, 20, 0.95, 5);  // p1: better, more bytes
  rows.add("ours", 2, 20, 0.94, 6);  // p2: beaten by p1
  rows.add("ours", 3, 20, 0.94, 4);  // p3: faster than p1
  rows.add("ours", 4, 10, 0.90, 5);  // p4: equal to p0, neither beats the other
  rows.add("ours", 5, 1, kNotApplicable, 1);
  const Analysis a = rows.analyse(kPareto);
  EXPECT_EQ(a.front, (std::vector<std::string>{"p0", "p1", "p3", "p4"}));
}

TEST(Analysis, AdviceKeepsTheLimits) {
  Rows rows;
  rows.add("ours", 0, 10, 0.90);
  rows.add("ours", 1, 20, 0.95);
  rows.add("ours", 2, 5, 0.80);
  const Analysis a = rows.analyse(kPareto);
  ASSERT_EQ(a.advice.size(), 2U);
  EXPECT_EQ(a.advice[0].id, "p0");
  EXPECT_EQ(a.advice[0].label, "ours, latency_ms 0");
  EXPECT_EQ(a.advice[1].id, "");
}

}  // namespace
}  // namespace atlaswire::lab
