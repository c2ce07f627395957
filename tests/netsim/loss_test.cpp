#include "netsim/loss.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace atlaswire::netsim {
namespace {

constexpr int kPackets = 400'000;

struct Runs {
  double share = 0;
  double mean_run = 0;
  double runs = 0;
};

Runs observe(const LossModel& model, std::uint64_t seed) {
  LossProcess process(seed);
  Runs out;
  bool before = false;
  double lost = 0;
  for (int i = 0; i < kPackets; ++i) {
    const bool now = process.lose(model, static_cast<std::uint64_t>(i));
    lost += now ? 1 : 0;
    out.runs += now && !before ? 1 : 0;
    before = now;
  }
  out.share = lost / kPackets;
  out.mean_run = out.runs > 0 ? lost / out.runs : 0;
  return out;
}

/// Standard deviation of the share lost among kPackets packets, which a chain of N states loses with chances
/// `loss` in its states, N square transitions `next`, stationary distribution `at`: the variance of one
/// packet, and the covariances of its successors, summed until they have died away.
template <std::size_t N>
double deviation_of_share(const double (&next)[N][N], const double (&at)[N], const double (&loss)[N]) {
  double share = 0;
  for (std::size_t i = 0; i < N; ++i) share += at[i] * loss[i];
  double ahead[N];  // expected loss k packets later, above the mean, by state now
  for (std::size_t i = 0; i < N; ++i) ahead[i] = loss[i] - share;
  double sum = share * (1 - share);
  for (int k = 1; k < 1000; ++k) {
    double further[N] = {};
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j) further[i] += next[i][j] * ahead[j];
      sum += 2 * at[i] * (loss[i] - share) * further[i];
    }
    std::copy(std::begin(further), std::end(further), ahead);
  }
  return std::sqrt(sum / kPackets);
}

TEST(LossProcess, NoneLosesNothing) { EXPECT_EQ(observe({}, 1).share, 0); }

TEST(LossProcess, BernoulliMatchesItsProbability) {
  const LossModel model{.kind = LossModel::Kind::kBernoulli, .probability = 0.03};
  EXPECT_NEAR(observe(model, 2).share, 0.03, 5 * std::sqrt(0.03 * 0.97 / kPackets));
}

TEST(LossProcess, BernoulliOfOneLosesAll) {
  EXPECT_EQ(observe({.kind = LossModel::Kind::kBernoulli, .probability = 1}, 3).share, 1);
}

TEST(LossProcess, GilbertElliottMatchesItsClosedForm) {
  LossModel model{.kind = LossModel::Kind::kGilbertElliott};
  model.p = 0.01;
  model.r = 0.2;
  const Runs seen = observe(model, 4);
  const double share = gilbert_elliott_loss(model);
  EXPECT_DOUBLE_EQ(share, 0.01 / 0.21);
  const double memory = 1 - model.p - model.r;  // second eigenvalue: autocorrelation of the chain
  const double deviation = std::sqrt(share * (1 - share) / kPackets * (1 + memory) / (1 - memory));
  EXPECT_NEAR(deviation_of_share<2>({{0.99, 0.01}, {0.2, 0.8}}, {1 - share, share}, {0, 1}), deviation, 1e-9);
  EXPECT_NEAR(seen.share, share, 5 * deviation);
  EXPECT_NEAR(seen.mean_run, 1 / model.r, 5 * std::sqrt((1 - model.r) / (model.r * model.r) / seen.runs));
}

TEST(LossProcess, GilbertElliottWithPartialLosses) {
  LossModel model{.kind = LossModel::Kind::kGilbertElliott};
  model.p = 0.05;
  model.r = 0.1;
  model.loss_good = 0.01;
  model.loss_bad = 0.5;
  const double share = gilbert_elliott_loss(model);
  EXPECT_NEAR(share, (1.0 / 3) * 0.5 + (2.0 / 3) * 0.01, 1e-12);
  const double deviation = deviation_of_share<2>({{0.95, 0.05}, {0.1, 0.9}}, {2.0 / 3, 1.0 / 3},
                                                 {model.loss_good, model.loss_bad});
  EXPECT_NEAR(observe(model, 5).share, share, 5 * deviation);
}

TEST(LossProcess, FourStatesMatchTheirStationaryDistribution) {
  LossModel model{.kind = LossModel::Kind::kFourState};
  model.p13 = 0.02;
  model.p31 = 0.3;
  model.p32 = 0.2;
  model.p23 = 0.5;
  model.p14 = 0.01;
  const double s1 = 1;
  const double s3 = s1 * model.p13 / model.p31;
  const double s2 = s3 * model.p32 / model.p23;
  const double s4 = s1 * model.p14;
  const double all = s1 + s2 + s3 + s4;
  const double deviation =
      deviation_of_share<4>({{0.97, 0, 0.02, 0.01}, {0, 0.5, 0.5, 0}, {0.3, 0.2, 0.5, 0}, {1, 0, 0, 0}},
                            {s1 / all, s2 / all, s3 / all, s4 / all}, {0, 0, 1, 1});
  EXPECT_NEAR(observe(model, 6).share, (s3 + s4) / all, 5 * deviation);
}

TEST(LossProcess, PeriodicLosesTheTailOfEachPeriod) {
  LossModel model{.kind = LossModel::Kind::kPeriodic};
  model.period = 10;
  model.burst = 3;
  LossProcess process(7);
  for (std::uint64_t i = 0; i < 100; ++i) ASSERT_EQ(process.lose(model, i), i % 10 >= 7) << i;
}

TEST(LossProcess, ListLosesExactlyItsPackets) {
  LossModel model{.kind = LossModel::Kind::kList};
  model.list = {0, 5, 99};
  LossProcess process(8);
  for (std::uint64_t i = 0; i < 120; ++i) ASSERT_EQ(process.lose(model, i), i == 0 || i == 5 || i == 99) << i;
}

}  // namespace
}  // namespace atlaswire::netsim
