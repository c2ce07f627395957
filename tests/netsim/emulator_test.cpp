#include "netsim/emulator.h"

#include "base/random.h"

#include <gtest/gtest.h>

namespace atlaswire::netsim {
namespace {

using std::chrono::milliseconds;

constexpr FlowId kMedia{1};
constexpr FlowId kControl{2};

Profile profile_named(const char* name) {
  auto profile = load_profile(name);
  EXPECT_TRUE(profile.has_value());
  return *profile;
}

struct Observed {
  std::vector<DirectedDecision> decisions;
  ByteBuffer stream;
  std::vector<Time> stream_arrivals;
  std::size_t datagrams = 0;
};

/// Datagrams and a byte stream downwards for a second; `look` sets how often the far end is served.
Observed drive(const Profile& profile, std::uint64_t seed, Duration look) {
  Emulator emulator(profile, seed, Time{});
  Random random(3);
  Observed run;
  const auto collect = [&](Time now) {
    for (const Delivery& d : emulator.deliver(now)) {
      if (d.flow == kMedia) {
        ++run.datagrams;
      } else {
        run.stream.insert(run.stream.end(), d.octets.begin(), d.octets.end());
        run.stream_arrivals.push_back(d.arrival);
      }
    }
    for (const DirectedDecision& d : emulator.take_decisions()) run.decisions.push_back(d);
  };
  std::uint8_t next_octet = 0;
  Time now{};
  for (int i = 0; i < 400; ++i) {
    const Time next = now + Duration{static_cast<std::int64_t>(random.below(5'000'000))};
    for (Time t = now + look; look > Duration::zero() && t < next; t += look) collect(t);
    now = next;
    emulator.datagram(kMedia, Direction::kDown, ByteBuffer(900), now);
    ByteBuffer octets(random.below(4000));
    for (std::byte& b : octets) b = static_cast<std::byte>(next_octet++);
    emulator.stream(kControl, Direction::kDown, octets, now);
  }
  collect(now + std::chrono::hours(1));
  return run;
}

TEST(Emulator, StreamsArriveWholeAndInOrderHoweverLossyTheLink) {
  const Observed run = drive(profile_named("lossy-wifi"), 5, Duration::zero());
  ASSERT_GT(run.stream.size(), 500'000U);
  for (std::size_t i = 0; i < run.stream.size(); ++i) {
    ASSERT_EQ(run.stream[i], static_cast<std::byte>(i & 0xFF)) << i;
  }
  EXPECT_TRUE(std::is_sorted(run.stream_arrivals.begin(), run.stream_arrivals.end()));
  EXPECT_LT(run.datagrams, 400U);
}

TEST(Emulator, DecisionsDoNotDependOnHowOftenItIsServed) {
  const Profile profile = profile_named("lossy-wifi");
  const Observed coarse = drive(profile, 6, Duration::zero());
  const Observed fine = drive(profile, 6, std::chrono::microseconds(137));
  EXPECT_EQ(fine.decisions, coarse.decisions);
  EXPECT_EQ(fine.stream_arrivals, coarse.stream_arrivals);
  EXPECT_NE(drive(profile, 7, Duration::zero()).decisions, coarse.decisions);
}

TEST(Emulator, ALostSegmentStallsAllBehindItForARoundTrip) {
  Profile profile = profile_named("paper-sas-100");
  for (LinkProfile* link : {&profile.up, &profile.down}) {
    link->steps[0].parameters.loss = {.kind = LossModel::Kind::kList, .list = {1}};
  }
  Emulator emulator(profile, 1, Time{});
  emulator.stream(kControl, Direction::kDown, ByteBuffer(3 * StreamLink::kSegmentOctets), Time{});
  std::vector<Delivery> all = emulator.deliver(Time{std::chrono::seconds(10)});
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].arrival, Time{milliseconds(50)});
  EXPECT_EQ(all[1].arrival, Time{milliseconds(150)})
      << "noticed a round trip later, and 50 ms to travel again";
  EXPECT_EQ(all[1].octets.size(), 2 * StreamLink::kSegmentOctets);
  EXPECT_EQ(emulator.stream_repeats(), 1U);
  EXPECT_EQ(emulator.outstanding(kControl, Direction::kDown), 0U);
}

/// The media's decisions of a run beside a stream, under `profile` and more of it.
std::vector<DirectedDecision> media_decisions(const std::string& more) {
  const auto profile = parse_profile(std::string(shipped_profile_text("lossy-wifi")) + more, "test", ".");
  EXPECT_TRUE(profile.has_value()) << profile.error().message();
  std::vector<DirectedDecision> media;
  for (const DirectedDecision& d : drive(*profile, 5, Duration::zero()).decisions) {
    if (d.decision.flow == kMedia) media.push_back(d);
  }
  return media;
}

TEST(Emulator, FlowsWithAPathOfTheirOwnLeaveOthersAlone) {
  const auto shared = media_decisions("");
  const auto apart = media_decisions("[[flow]]\nkind = \"stream\"\n");
  const auto apart_slowly =
      media_decisions("[[flow]]\nkind = \"stream\"\n[flow.down]\nrate = { mbps = 0.1 }\n");
  EXPECT_EQ(apart, apart_slowly) << "what happens on the streams' path does not matter";
  ASSERT_EQ(apart.size(), 400U);
  EXPECT_EQ(apart.back().decision.packet, 399U);
  EXPECT_EQ(apart.back().path, PathId{0});
  EXPECT_GT(shared.back().decision.packet, 800U) << "streams and media are numbered together";
  const auto own = media_decisions("[[flow]]\nnumbers = [1]\n");
  EXPECT_EQ(own.back().path, PathId{1});
  EXPECT_NE(own[0].decision.delivered, apart[0].decision.delivered) << "draws of its own";
}

TEST(Emulator, AStreamsRepeatsTakeItsOwnPathsRoundTrip) {
  const auto profile = parse_profile(R"(
[both]
delay = { base_ms = 5 }
[[flow]]
numbers = [2]
[flow.both]
delay = { base_ms = 50 }
loss = { kind = "list", packets = [0] }
)",
                                     "test", ".");
  ASSERT_TRUE(profile.has_value()) << profile.error().message();
  Emulator emulator(*profile, 1, Time{});
  emulator.stream(kControl, Direction::kDown, ByteBuffer(10), Time{});
  emulator.stream(FlowId{3}, Direction::kDown, ByteBuffer(10), Time{});
  const auto all = emulator.deliver(Time{std::chrono::seconds(1)});
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].flow, FlowId{3});
  EXPECT_EQ(all[0].arrival, Time{milliseconds(5)});
  EXPECT_EQ(all[1].arrival, Time{milliseconds(150)});
  EXPECT_EQ(emulator.stream_repeats(), 1U);
}

TEST(Emulator, AClosedStreamIsForgotten) {
  Emulator emulator(profile_named("paper-sas-20"), 1, Time{});
  emulator.stream(kControl, Direction::kUp, ByteBuffer(100), Time{});
  emulator.close_stream(kControl);
  EXPECT_EQ(emulator.outstanding(kControl, Direction::kUp), 0U);
  EXPECT_LE(emulator.deliver(Time{std::chrono::seconds(1)}).size(), 1U);
  EXPECT_FALSE(emulator.next_event().has_value());
}

}  // namespace
}  // namespace atlaswire::netsim
