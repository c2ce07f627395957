#include "netsim/loss.h"

#include <gtest/gtest.h>

#include <cmath>
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
  EXPECT_NEAR(seen.share, share, 5 * std::sqrt(share * (1 - share) / kPackets * (1 + memory) / (1 - memory)));
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
  EXPECT_NEAR(observe(model, 5).share, share, 5 * std::sqrt(share * (1 - share) / kPackets * 1.85 / 0.15));
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
  const double share = (s3 + s4) / (s1 + s2 + s3 + s4);
  EXPECT_NEAR(observe(model, 6).share, share, 5 * std::sqrt(share * (1 - share) / kPackets * 10));
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
