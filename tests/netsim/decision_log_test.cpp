#include "netsim/decision_log.h"

#include "base/random.h"

#include <gtest/gtest.h>

namespace atlaswire::netsim {
namespace {

/// Everything that can happen, often: a busy queue, losses, copies, damage, a blackout.
constexpr const char* kRough = R"(
[both]
delay = { shape = "normal", base_ms = 8, spread_ms = 3, correlation = 0.4 }
loss = { kind = "gilbert-elliott", p = 0.05, r = 0.4 }
rate = { mbps = 4 }
queue = { policy = "codel", limit_kb = 24, limit_ms = 40 }
duplicate = 0.05
corrupt = 0.05
reorder = 0.05
[[both.step]]
at_ms = 800
down = true
[[both.step]]
at_ms = 900
)";

Profile rough(const std::string& queue = "codel") {
  std::string text = kRough;
  text.replace(text.find("codel"), 5, queue);
  auto profile = parse_profile(text, "rough", ".");
  EXPECT_TRUE(profile.has_value()) << profile.error().message();
  return *profile;
}

/// Lines of a run of datagrams and a stream, both ways, served at odd moments, as the live relay would.
std::string recorded_run(const Profile& profile, std::uint64_t seed, Time start) {
  Emulator emulator(profile, seed, start);
  Random random(11);
  std::string text(decision_log_header());
  text += '\n';
  const auto write = [&] {
    for (const DirectedDecision& d : emulator.take_decisions()) text += format_decision(d, start) + '\n';
  };
  Time now = start;
  for (int i = 0; i < 1500; ++i) {
    now += Duration{static_cast<std::int64_t>(random.below(2'000'000))};
    const Direction way = random.below(2) == 0 ? Direction::kUp : Direction::kDown;
    if (random.below(10) == 0) {
      emulator.stream(FlowId{7}, way, ByteBuffer(random.below(3000)), now);
    } else {
      emulator.datagram(FlowId{static_cast<std::uint32_t>(random.below(3))}, way,
                        ByteBuffer(random.below(1400)), now);
    }
    if (random.below(3) == 0) {
      (void)emulator.deliver(now);
      write();
    }
  }
  emulator.finish();
  write();
  return text;
}

TEST(DecisionLog, EveryFieldSurvivesTheRoundTrip) {
  const DirectedDecision d{Direction::kDown,
                           {.packet = 0,
                            .flow = FlowId{4'000'000'000},
                            .size = 65'507,
                            .arrived = Time{std::chrono::seconds(3)},
                            .left_queue = Time{Duration{3'000'000'001}},
                            .delivered = Time{Duration{3'000'000'002}},
                            .ecn = Ecn::kCapable0,
                            .corrupted = true,
                            .marked = true,
                            .reordered = true},
                           PathId{16}};
  const std::string line = format_decision(d, Time{});
  EXPECT_EQ(line, "down,16,0,4000000000,65507,2,3000000000,3000000001,3000000002,delivered,1,0,1,1");
  const auto parsed = parse_decision_log(line + "\n");
  ASSERT_TRUE(parsed.has_value()) << parsed.error().message();
  ASSERT_EQ(parsed->size(), 1U);
  EXPECT_EQ((*parsed)[0], d);
  EXPECT_EQ(format_decision(d, Time{std::chrono::seconds(1)}),
            "down,16,0,4000000000,65507,2,2000000000,2000000001,2000000002,delivered,1,0,1,1")
      << "times count from the run's start";
}

TEST(DecisionLog, AReplayInVirtualTimeTakesTheSameDecisions) {
  for (const char* queue : {"codel", "pie", "drop-tail", "drop-head"}) {
    const Profile profile = rough(queue);
    const auto log = parse_decision_log(recorded_run(profile, 21, from_nanos(987'654'321'012)));
    ASSERT_TRUE(log.has_value()) << log.error().message();
    bool seen[7] = {};
    for (const DirectedDecision& d : *log) seen[static_cast<std::size_t>(d.decision.fate)] = true;
    EXPECT_TRUE(seen[0] && seen[1] && seen[2]) << "a run worth comparing";
    EXPECT_EQ(replay(*log, profile, 21), *log) << queue;
    EXPECT_NE(replay(*log, profile, 22), *log) << "another seed is another network";
    EXPECT_NE(replay(*log, rough(queue == std::string("codel") ? "drop-tail" : "codel"), 21), *log);
  }
}

TEST(DecisionLog, PathsOfFlowsReplayToo) {
  const char* rules =
      "[[flow]]\nkind = \"stream\"\n[[flow]]\nnumbers = [2]\n"
      "[flow.up]\nloss = { kind = \"bernoulli\", probability = 0.3 }\n";
  const auto profile = parse_profile(kRough + std::string(rules), "rules", ".");
  ASSERT_TRUE(profile.has_value()) << profile.error().message();
  const auto log = parse_decision_log(recorded_run(*profile, 21, from_nanos(77)));
  ASSERT_TRUE(log.has_value()) << log.error().message();
  std::size_t on_path[3] = {};
  for (const DirectedDecision& d : *log) ++on_path[static_cast<std::size_t>(d.path)];
  EXPECT_GT(on_path[0], 500U);
  EXPECT_GT(on_path[1], 100U);
  EXPECT_GT(on_path[2], 200U);
  EXPECT_EQ(replay(*log, *profile, 21), *log);
  EXPECT_NE(replay(*log, *profile, 22), *log);
  EXPECT_LT(replay(*log, rough(), 21).size(), log->size()) << "a profile without these paths";
}

TEST(DecisionLog, MarksReplayToo) {
  std::string text = kRough;
  text.replace(text.find("limit_kb = 24, limit_ms = 40"), 28, "limit_kb = 24, ecn = true");
  const Profile profile = *parse_profile(text, "marking", ".");
  Emulator emulator(profile, 1, Time{});
  for (int i = 0; i < 600; ++i)  // 1.5 times the rate
    emulator.datagram(FlowId{1}, Direction::kUp, ByteBuffer(750), Time{std::chrono::milliseconds(i)},
                      static_cast<Ecn>(i % 4));
  emulator.finish();
  std::string log_text;
  for (const DirectedDecision& d : emulator.take_decisions()) log_text += format_decision(d, Time{}) + '\n';
  const auto log = parse_decision_log(log_text);
  ASSERT_TRUE(log.has_value()) << log.error().message();
  std::size_t marked = 0;
  for (const DirectedDecision& d : *log) {
    if (d.decision.marked) ++marked;
    EXPECT_FALSE(d.decision.marked && d.decision.ecn == Ecn::kNotCapable);
    EXPECT_FALSE(d.decision.fate == Fate::kEarlyDrop && d.decision.ecn != Ecn::kNotCapable);
  }
  EXPECT_GT(marked, 0U);
  EXPECT_EQ(replay(*log, profile, 1), *log);
}

TEST(DecisionLog, PacketsThatNeverLeaveAreUnsentNotMissing) {
  Profile profile = *load_profile("paper-sas-20");
  profile.up.steps[0].parameters.rate.rate = BitRate{0};
  const auto log = parse_decision_log(recorded_run(profile, 3, Time{}));
  ASSERT_TRUE(log.has_value()) << log.error().message();
  EXPECT_EQ((*log)[0].decision.fate, Fate::kUnsent);
  EXPECT_EQ(replay(*log, profile, 3), *log);
}

TEST(DecisionLog, BadLinesAreNamed) {
  const std::string good = "up,0,0,1,100,0,5,6,7,delivered,0,0,0,0\n";
  const std::pair<std::string, const char*> cases[] = {
      {"sideways,0,0,1,100,0,5,6,7,delivered,0,0,0,0", "line 2"},
      {"up,0,1,1,100,0,5,6,7,delivered,0,0,0", "line 2"},
      {"up,0,1,1,100,0,5,6,7,delivered,0,0,0,0,0", "line 2"},
      {"up,0,1,1,100,0,5,6,7,eaten,0,0,0,0", "line 2"},
      {"up,0,1,1,65536,0,5,6,7,delivered,0,0,0,0", "line 2"},
      {"up,17,0,1,100,0,5,6,7,delivered,0,0,0,0", "line 2"},
      {"up,0,1,1,100,4,5,6,7,delivered,0,0,0,0", "line 2"},
      {"up,3,1,1,100,0,5,6,7,delivered,0,0,0,0", "up path 3 packet 0 is missing"},
      {"up,0,1,1,100,0,-5,6,7,delivered,0,0,0,0", "line 2"},
      {"up,0,1,1,100,0,9000000000000000000,6,7,delivered,0,0,0,0", "line 2"},
      {"up,0,1,4294967296,100,0,5,6,7,delivered,0,0,0,0", "line 2"},
      {"up,0,1,1,100,0,5x,6,7,delivered,0,0,0,0", "line 2"},
      {"up,0,1,1,100,0,4,6,7,delivered,0,0,0,0", "up packet 1 arrived before the one before it"},
      {"up,0,2,1,100,0,5,6,7,delivered,0,0,0,0", "up packet 1 is missing"},
      {"down,0,1,1,100,0,5,6,7,delivered,0,0,0,0", "down packet 0 is missing"},
      {"up,0,0,1,100,0,5,6,7,delivered,0,0,0,0", "up packet 1 is missing or there twice"},
      {"up,0,5,1,100,0,5,6,7,delivered,0,1,0,0", "up packet 1 has copies and no original"},
  };
  for (const auto& [line, expected] : cases) {
    const auto parsed = parse_decision_log(good + line + "\n");
    ASSERT_TRUE(parsed.has_error()) << line;
    EXPECT_NE(parsed.error().message().find(expected), std::string::npos)
        << line << ": " << parsed.error().message();
  }
}

}  // namespace
}  // namespace atlaswire::netsim
