#include "netsim/aqm.h"

#include "netsim/link.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace atlaswire::netsim {
namespace {

using std::chrono::milliseconds;
constexpr std::uint64_t kDeep = 100'000;

TEST(Codel, WaitsAnIntervalThenDropsAtIntervalOverRootOfCount) {
  QueueModel model;
  Codel codel;
  std::vector<Time> drops;
  for (Time now{}; now < Time{milliseconds(800)}; now += milliseconds(1)) {
    while (codel.drop(model, milliseconds(20), kDeep, now)) drops.push_back(now);
  }
  ASSERT_GE(drops.size(), 6U);
  EXPECT_EQ(drops[0], Time{milliseconds(100)});
  double expected = 100;
  for (std::size_t n = 1; n < 6; ++n) {
    expected += 100 / std::sqrt(static_cast<double>(n));
    EXPECT_NEAR(to_ms(drops[n] - Time{}), expected, 1.0) << n;
  }
}

TEST(Codel, BelowTargetOrOnePacketNeverDrops) {
  QueueModel model;
  Codel codel;
  for (Time now{}; now < Time{milliseconds(1000)}; now += milliseconds(1)) {
    ASSERT_FALSE(codel.drop(model, milliseconds(4), kDeep, now));
    ASSERT_FALSE(codel.drop(model, milliseconds(50), 1000, now));
  }
}

TEST(Codel, ResumesNearItsOldRateAfterAShortPause) {
  QueueModel model;
  Codel codel;
  std::uint32_t first_phase = 0;
  Time now{};
  for (; now < Time{milliseconds(1500)}; now += milliseconds(1)) {
    first_phase += codel.drop(model, milliseconds(20), kDeep, now) ? 1U : 0U;
  }
  ASSERT_FALSE(codel.drop(model, milliseconds(1), kDeep, now));
  std::vector<Time> drops;
  for (; drops.size() < 2; now += milliseconds(1)) {
    if (codel.drop(model, milliseconds(20), kDeep, now)) drops.push_back(now);
  }
  EXPECT_LT(drops[1] - drops[0], milliseconds(60)) << "count was remembered; a fresh start would wait 100 ms";
  EXPECT_GT(first_phase, 10U);
}

LinkProfile overloaded(QueueModel::Policy policy, Duration target) {
  LinkProfile profile;
  profile.steps.resize(1);
  auto& p = profile.steps[0].parameters;
  p.rate.rate = BitRate{8'000'000};
  p.queue.policy = policy;
  p.queue.target = target;
  p.queue.limit = Bytes{4'000'000};
  return profile;
}

TEST(Pie, HoldsTheDelayNearItsTargetUnderOverload) {
  Link link(overloaded(QueueModel::Policy::kPie, milliseconds(15)), 5, Time{});
  std::vector<Decision> decisions;
  Time now{};
  // 1000-octet packets (972 and overhead) every 0.8 ms: 1.25 times the rate; a fifth must go.
  for (int i = 0; i < 50'000; ++i, now += std::chrono::microseconds(800)) {
    link.send(ByteBuffer(972), now);
    (void)link.deliver(now);
    for (const Decision& d : link.take_decisions()) decisions.push_back(d);
  }
  double dropped = 0;
  double delay = 0;
  double served = 0;
  for (const Decision& d : decisions) {
    if (d.packet < 25'000) continue;
    if (d.fate == Fate::kEarlyDrop) {
      dropped += 1;
    } else {
      delay += to_ms(d.left_queue - d.arrived);
      served += 1;
    }
  }
  EXPECT_NEAR(dropped / (dropped + served), 0.2, 0.02);
  EXPECT_NEAR(delay / served, 15, 6);
}

TEST(Codel, InALinkItBoundsTheStandingQueue) {
  Link link(overloaded(QueueModel::Policy::kCodel, milliseconds(5)), 6, Time{});
  Time now{};
  double worst = 0;
  for (int i = 0; i < 60'000; ++i, now += std::chrono::microseconds(950)) {
    link.send(ByteBuffer(972), now);
    (void)link.deliver(now);
    for (const Decision& d : link.take_decisions()) {
      if (d.packet > 30'000 && d.fate == Fate::kDelivered)
        worst = std::max(worst, to_ms(d.left_queue - d.arrived));
    }
  }
  EXPECT_LT(worst, 60) << "drop-tail would stand at 4 s";
  EXPECT_GT(worst, 1);
}

}  // namespace
}  // namespace atlaswire::netsim
