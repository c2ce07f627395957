#include "netsim/bottleneck.h"

#include "base/random.h"
#include "netsim/profile.h"

#include <gtest/gtest.h>

#include <vector>

namespace atlaswire::netsim {
namespace {

using std::chrono::milliseconds;

struct Sent {
  Time end{};
  std::uint64_t octets = 0;
};

std::vector<Sent> run(const RateModel& model, std::uint64_t seed, int packets, double mean_gap_seconds) {
  Bottleneck bottleneck(Time{});
  Random random(seed);
  std::vector<Sent> out;
  Time ready{};
  for (int i = 0; i < packets; ++i) {
    ready += from_seconds(mean_gap_seconds * 2 * random.uniform());
    const std::uint64_t octets = 1 + random.below(1500);
    const auto service = bottleneck.plan(model, ready, octets);
    EXPECT_TRUE(service.has_value());
    EXPECT_GE(service->start, ready);
    bottleneck.commit(model, *service, ready, octets);
    out.push_back({service->end, octets});
  }
  return out;
}

TEST(TokenBucket, NoWindowExceedsRateAndDepth) {
  for (const std::uint64_t depth : {0U, 1000U, 20'000U}) {
    const RateModel model{.rate = BitRate{8'000'000}, .burst = Bytes{depth}};
    const auto sent = run(model, 11 + depth, 2000, 0.0008);
    for (std::size_t i = 0; i < sent.size(); ++i) {
      std::uint64_t octets = 0;
      for (std::size_t j = i; j < std::min(sent.size(), i + 200); ++j) {
        octets += sent[j].octets;
        // The window opens just before packet i ends: its own octets may all have come from the bucket,
        // or have been on the wire before.
        const double allowed =
            1e-6 + 1e6 * to_seconds(sent[j].end - sent[i].end) + static_cast<double>(depth);
        ASSERT_LE(static_cast<double>(octets), allowed + static_cast<double>(sent[i].octets))
            << i << " " << j;
      }
    }
  }
}

TEST(TokenBucket, SaturatedItGivesExactlyItsRate) {
  const RateModel model{.rate = BitRate{12'000'000}};
  const auto sent = run(model, 3, 5000, 0);
  std::uint64_t octets = 0;
  for (const Sent& s : sent) octets += s.octets;
  const double seconds = static_cast<double>(octets) * 8 / 12e6;
  EXPECT_NEAR(to_seconds(sent.back().end - Time{}), seconds, 5000e-9);  // at most 1 ns rounding a packet
}

TEST(TokenBucket, IdleFillsTheBucket) {
  const RateModel model{.rate = BitRate{8'000'000}, .burst = Bytes{3000}};
  Bottleneck bottleneck(Time{});
  const Time later = Time{milliseconds(100)};
  for (int i = 0; i < 3; ++i) {
    const auto service = bottleneck.plan(model, later, 1000);
    EXPECT_EQ(service->end, later) << "packet " << i << " fits the bucket";
    bottleneck.commit(model, *service, later, 1000);
  }
  EXPECT_EQ(bottleneck.plan(model, later, 1000)->end, later + milliseconds(1));
}

TEST(TokenBucket, ZeroRateNeverServesAndInfiniteAlways) {
  Bottleneck bottleneck(Time{});
  EXPECT_FALSE(bottleneck.plan({.rate = BitRate{0}}, Time{}, 10).has_value());
  EXPECT_EQ(bottleneck.plan({}, Time{milliseconds(3)}, 1'000'000)->end, Time{milliseconds(3)});
}

TEST(TokenBucket, RateChangeKeepsTheOctetsOwed) {
  const RateModel slow{.rate = BitRate{8'000'000}};
  const RateModel fast{.rate = BitRate{80'000'000}};
  Bottleneck bottleneck(Time{});
  const auto first = bottleneck.plan(slow, Time{}, 10'000);  // 10 ms at the slow rate
  bottleneck.commit(slow, *first, Time{}, 10'000);
  bottleneck.change_rate(slow, fast, Time{milliseconds(5)});
  EXPECT_EQ(bottleneck.plan(fast, Time{milliseconds(5)}, 1000)->start,
            Time{milliseconds(5)} + std::chrono::microseconds(500));
}

TEST(Trace, SaturatedItGivesEveryOpportunity) {
  const auto model = parse_trace("2\n2\n5\n10\n");
  ASSERT_TRUE(model.has_value());
  Bottleneck bottleneck(Time{});
  std::vector<Time> ends;
  for (int i = 0; i < 9; ++i) {
    const auto service = bottleneck.plan(*model, Time{}, kOpportunityOctets);
    bottleneck.commit(*model, *service, Time{}, kOpportunityOctets);
    ends.push_back(service->end);
  }
  const int expected[] = {2, 2, 5, 10, 12, 12, 15, 20, 22};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(ends[i], Time{milliseconds(expected[i])}) << i;
}

TEST(Trace, SmallPacketsShareAnOpportunityAndLargeOnesSpanSeveral) {
  const auto model = parse_trace("1\n2\n3\n4\n");
  Bottleneck bottleneck(Time{});
  const auto serve = [&](std::uint64_t octets) {
    const auto service = bottleneck.plan(*model, Time{}, octets);
    bottleneck.commit(*model, *service, Time{}, octets);
    return service->end;
  };
  EXPECT_EQ(serve(700), Time{milliseconds(1)});
  EXPECT_EQ(serve(700), Time{milliseconds(1)});
  EXPECT_EQ(serve(200), Time{milliseconds(2)});  // 104 octets in the first, 96 in the second
  EXPECT_EQ(serve(3000), Time{milliseconds(4)});
}

TEST(Trace, AnOpportunityMissedIsGone) {
  const auto model = parse_trace("1\n9\n10\n");
  Bottleneck bottleneck(Time{});
  const Time ready = Time{milliseconds(23)};
  EXPECT_EQ(bottleneck.plan(*model, ready, 100)->end, Time{milliseconds(29)});
  EXPECT_EQ(bottleneck.plan(*model, Time{milliseconds(30)}, 100)->end, Time{milliseconds(30)});
}

}  // namespace
}  // namespace atlaswire::netsim
