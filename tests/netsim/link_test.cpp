#include "netsim/link.h"

#include "base/random.h"
#include "netsim/path.h"

#include <gtest/gtest.h>

#include <bit>
#include <map>

namespace atlaswire::netsim {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

LinkProfile one_step(const LinkParameters& p) {
  LinkProfile profile;
  profile.steps.resize(1);
  profile.steps[0].parameters = p;
  return profile;
}

ByteBuffer payload(std::uint64_t number, std::size_t size) {
  ByteBuffer out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::byte>((number * 131 + i) & 0xFF);
  return out;
}

struct Outcome {
  std::vector<Decision> decisions;
  std::vector<std::pair<std::uint64_t, Time>> arrivals;
  bool operator==(const Outcome&) const = default;
};

/// Sends `count` packets at random gaps, looking at the link every `look` (zero: only at the end).
Outcome drive(const LinkProfile& profile, std::uint64_t seed, int count, Duration look) {
  Link link(profile, seed, Time{});
  Random random(99);
  Outcome out;
  Time now{};
  const auto collect = [&](Time at) {
    for (const Datagram& d : link.deliver(at)) out.arrivals.emplace_back(d.packet, d.arrival);
    for (const Decision& d : link.take_decisions()) out.decisions.push_back(d);
  };
  for (int i = 0; i < count; ++i) {
    const Time next = now + Duration{static_cast<std::int64_t>(random.below(1'500'000))};
    if (look > Duration::zero()) {
      for (; now < next; now = std::min(now + look, next)) collect(now);
    }
    now = next;
    const auto size = static_cast<std::size_t>(1 + random.below(1200));
    link.send(payload(static_cast<std::uint64_t>(i), size), now);
  }
  collect(now + std::chrono::hours(1));
  return out;
}

LinkParameters busy() {
  LinkParameters p;
  p.delay = {.shape = DelayModel::Shape::kPareto, .base = milliseconds(5), .spread = milliseconds(4)};
  p.loss = {.kind = LossModel::Kind::kGilbertElliott, .p = 0.02, .r = 0.3};
  p.rate.rate = BitRate{6'000'000};
  p.queue.limit = Bytes{30'000};
  p.duplicate = 0.02;
  p.corrupt = 0.05;
  p.reorder = 0.03;
  return p;
}

TEST(Link, DecisionsDoNotDependOnHowOftenItIsLookedAt) {
  for (const auto policy : {QueueModel::Policy::kDropTail, QueueModel::Policy::kDropHead,
                            QueueModel::Policy::kCodel, QueueModel::Policy::kPie}) {
    LinkParameters p = busy();
    p.queue.policy = policy;
    LinkProfile profile = one_step(p);
    profile.steps.push_back({.at = milliseconds(300), .down = true, .parameters = p});
    profile.steps.push_back({.at = milliseconds(450), .down = false, .parameters = p});
    profile.steps.back().parameters.rate.rate = BitRate{3'000'000};
    const Outcome coarse = drive(profile, 7, 2000, Duration::zero());
    EXPECT_EQ(drive(profile, 7, 2000, Duration::zero()), coarse) << "two equal runs";
    EXPECT_EQ(drive(profile, 7, 2000, microseconds(70)), coarse) << "a run looked at often";
    EXPECT_NE(drive(profile, 8, 2000, Duration::zero()), coarse) << "another seed";
  }
}

TEST(Link, EveryPacketHasExactlyOneFate) {
  const Outcome out = drive(one_step(busy()), 3, 3000, milliseconds(1));
  std::map<std::uint64_t, int> fates;
  std::size_t delivered = 0;
  for (const Decision& d : out.decisions) {
    if (!d.duplicate) ++fates[d.packet];
    if (d.fate == Fate::kDelivered) ++delivered;
  }
  EXPECT_EQ(fates.size(), 3000U);
  for (const auto& [packet, count] : fates) ASSERT_EQ(count, 1) << packet;
  EXPECT_EQ(out.arrivals.size(), delivered);
}

TEST(Link, RateDoesNotChangeWhichPacketsTheAirLoses) {
  LinkParameters p = busy();
  p.queue.limit = Bytes{100'000'000};
  const auto lost = [](const Outcome& out) {
    std::vector<std::uint64_t> packets;
    for (const Decision& d : out.decisions) {
      if (d.fate == Fate::kLost) packets.push_back(d.packet);
    }
    return packets;
  };
  const auto slow = lost(drive(one_step(p), 5, 2000, Duration::zero()));
  p.rate.rate = BitRate{60'000'000};
  EXPECT_EQ(lost(drive(one_step(p), 5, 2000, Duration::zero())), slow);
  EXPECT_FALSE(slow.empty());
}

TEST(Link, JitterAloneNeverReorders) {
  LinkParameters p = busy();
  p.reorder = 0;
  p.duplicate = 0;
  const Outcome out = drive(one_step(p), 9, 3000, Duration::zero());
  for (std::size_t i = 1; i < out.arrivals.size(); ++i)
    ASSERT_LT(out.arrivals[i - 1].first, out.arrivals[i].first);
}

TEST(Link, ReorderedPacketsOvertake) {
  LinkParameters p;
  p.delay.base = milliseconds(50);
  p.reorder = 0.1;
  const Outcome out = drive(one_step(p), 10, 2000, Duration::zero());
  int early = 0;
  for (std::size_t i = 1; i < out.arrivals.size(); ++i)
    early += out.arrivals[i].first < out.arrivals[i - 1].first ? 1 : 0;
  EXPECT_GT(early, 50);
}

TEST(Link, CorruptionFlipsExactlyOneBit) {
  LinkParameters p;
  p.corrupt = 1;
  Link link(one_step(p), 1, Time{});
  for (std::uint64_t i = 0; i < 200; ++i) {
    link.send(payload(i, 100), Time{milliseconds(i)});
    const auto got = link.deliver(Time{milliseconds(i)});
    ASSERT_EQ(got.size(), 1U);
    int flipped = 0;
    const ByteBuffer sent = payload(i, 100);
    for (std::size_t b = 0; b < 100; ++b) {
      flipped += std::popcount(std::to_integer<std::uint8_t>(sent[b] ^ got[0].payload[b]));
    }
    ASSERT_EQ(flipped, 1);
  }
}

TEST(Link, ConstantDelayAndRateAddUpExactly) {
  LinkParameters p;
  p.delay.base = milliseconds(10);
  p.rate.rate = BitRate{8'000'000};
  p.overhead = Bytes{0};
  Link link(one_step(p), 1, Time{});
  link.send(payload(0, 1000), Time{});
  link.send(payload(1, 500), Time{});
  const auto got = link.deliver(Time{milliseconds(100)});
  ASSERT_EQ(got.size(), 2U);
  EXPECT_EQ(got[0].arrival, Time{milliseconds(11)});
  EXPECT_EQ(got[1].arrival, Time{microseconds(11'500)});
}

TEST(Link, TailAndHeadDropKeepTheBound) {
  for (const auto policy : {QueueModel::Policy::kDropTail, QueueModel::Policy::kDropHead}) {
    LinkParameters p;
    p.rate.rate = BitRate{800'000};
    p.queue = {.policy = policy, .limit = Bytes{5000}};
    p.overhead = Bytes{0};
    Link link(one_step(p), 1, Time{});
    std::vector<std::uint64_t> dropped;
    for (std::uint64_t i = 0; i < 20; ++i) {
      link.send(payload(i, 1000), Time{});
      ASSERT_LE(link.backlog(), 5000U);
    }
    for (const Decision& d : link.take_decisions()) {
      if (d.fate == Fate::kQueueFull) dropped.push_back(d.packet);
    }
    ASSERT_EQ(dropped.size(), 14U);  // one in service, five waiting
    EXPECT_EQ(dropped.front(), policy == QueueModel::Policy::kDropTail ? 6U : 1U);
  }
}

TEST(Link, TimeLimitedQueueLetsOldPacketsGo) {
  LinkParameters p;
  p.rate.rate = BitRate{800'000};  // 10 ms a packet
  p.queue.time_limit = milliseconds(25);
  p.overhead = Bytes{0};
  Link link(one_step(p), 1, Time{});
  for (std::uint64_t i = 0; i < 10; ++i) link.send(payload(i, 1000), Time{});
  EXPECT_EQ(link.deliver(Time{milliseconds(500)}).size(), 3U);
}

TEST(Link, BlackoutLosesArrivalsAndHoldsTheQueue) {
  LinkParameters p;
  p.rate.rate = BitRate{800'000};
  p.overhead = Bytes{0};
  LinkProfile profile = one_step(p);
  profile.steps.push_back({.at = milliseconds(15), .down = true, .parameters = p});
  profile.steps.push_back({.at = milliseconds(100), .down = false, .parameters = p});
  Link link(profile, 1, Time{});
  for (std::uint64_t i = 0; i < 3; ++i) link.send(payload(i, 1000), Time{});
  link.send(payload(3, 1000), Time{milliseconds(50)});
  const auto got = link.deliver(Time{milliseconds(200)});
  ASSERT_EQ(got.size(), 3U);
  EXPECT_EQ(got[1].arrival, Time{milliseconds(20)}) << "being sent when the link went down: it ends";
  EXPECT_EQ(got[2].arrival, Time{milliseconds(110)});
  const auto decisions = link.take_decisions();
  EXPECT_TRUE(std::any_of(decisions.begin(), decisions.end(),
                          [](const Decision& d) { return d.packet == 3 && d.fate == Fate::kBlackout; }));
}

TEST(Link, FullLossAndZeroRateDeliverNothing) {
  LinkParameters lossy;
  lossy.loss = {.kind = LossModel::Kind::kBernoulli, .probability = 1};
  EXPECT_TRUE(drive(one_step(lossy), 1, 100, Duration::zero()).arrivals.empty());
  LinkParameters stopped;
  stopped.rate.rate = BitRate{0};
  EXPECT_TRUE(drive(one_step(stopped), 1, 100, Duration::zero()).arrivals.empty());
}

TEST(Link, EcnMarksCapablePacketsInsteadOfDropping) {
  LinkParameters p;
  p.rate.rate = BitRate{8'000'000};
  p.queue = {.policy = QueueModel::Policy::kCodel, .limit = Bytes{10'000'000}, .ecn = true};
  Link link(one_step(p), 1, Time{});
  int marked = 0;
  Time now{};
  for (int i = 0; i < 3000; ++i, now += microseconds(900)) {
    link.send(ByteBuffer(972), now, FlowId{}, Ecn::kCapable0);
    for (const Datagram& d : link.deliver(now)) marked += d.ecn == Ecn::kCongestion ? 1 : 0;
  }
  EXPECT_GT(marked, 3);
  for (const Decision& d : link.take_decisions()) EXPECT_NE(d.fate, Fate::kEarlyDrop);
}

TEST(Link, NextEventLeadsToEveryArrival) {
  Link link(one_step(busy()), 4, Time{});
  for (std::uint64_t i = 0; i < 200; ++i) link.send(payload(i, 700), Time{microseconds(i * 300)});
  std::size_t arrivals = 0;
  int turns = 0;
  while (const auto next = link.next_event()) {
    arrivals += link.deliver(*next).size();
    ASSERT_LT(++turns, 5000);
  }
  std::size_t delivered = 0;
  for (const Decision& d : link.take_decisions()) delivered += d.fate == Fate::kDelivered ? 1U : 0U;
  EXPECT_EQ(arrivals, delivered);
  EXPECT_GT(arrivals, 20U);
}

TEST(Path, DirectionsDrawIndependently) {
  const auto profile = load_profile("lossy-wifi");
  ASSERT_TRUE(profile.has_value()) << profile.error().message();
  Path path(*profile, PathId{0}, 5, Time{});
  std::vector<bool> lost[2];
  for (std::uint64_t i = 0; i < 2000; ++i) {
    for (const Direction d : {Direction::kUp, Direction::kDown})
      path.link(d).send(payload(i, 100), Time{milliseconds(i)});
  }
  EXPECT_TRUE(path.next_event().has_value());
  for (const Direction d : {Direction::kUp, Direction::kDown}) {
    (void)path.link(d).deliver(Time{std::chrono::hours(1)});
    for (const Decision& decision : path.link(d).take_decisions()) {
      lost[static_cast<std::size_t>(d)].push_back(decision.fate == Fate::kLost);
    }
  }
  EXPECT_NE(lost[0], lost[1]);
}

}  // namespace
}  // namespace atlaswire::netsim
