#include "netsim/virtual_driver.h"

#include <gtest/gtest.h>

namespace atlaswire::netsim {
namespace {

using std::chrono::milliseconds;

constexpr FlowId kDatagrams{1};
constexpr FlowId kStream{2};

/// Sends a numbered datagram every 10 ms and notes when its echo comes back; streams one octet beside it.
class Pinger final : public Endpoint {
 public:
  void receive(FlowId flow, ByteView octets, Time now) override {
    if (flow == kStream) {
      stream_octets += octets.size();
    } else {
      echoes.emplace_back(std::to_integer<int>(octets[0]), now);
    }
  }
  [[nodiscard]] std::optional<Time> next_deadline() const override { return next_; }
  void wake(Time now) override {
    outgoing_.push_back({kDatagrams, false, ByteBuffer(100, static_cast<std::byte>(sent++))});
    outgoing_.push_back({kStream, true, ByteBuffer(1)});
    next_ = now + milliseconds(10);
  }
  std::vector<Outgoing> take_outgoing() override { return std::exchange(outgoing_, {}); }

  std::vector<std::pair<int, Time>> echoes;
  std::size_t stream_octets = 0;
  int sent = 0;

 private:
  Time next_{};
  std::vector<Outgoing> outgoing_;
};

class Echo final : public Endpoint {
 public:
  void receive(FlowId flow, ByteView octets, Time /*now*/) override {
    outgoing_.push_back({flow, flow == kStream, ByteBuffer(octets.begin(), octets.end())});
  }
  [[nodiscard]] std::optional<Time> next_deadline() const override { return std::nullopt; }
  void wake(Time /*now*/) override {}
  std::vector<Outgoing> take_outgoing() override { return std::exchange(outgoing_, {}); }

 private:
  std::vector<Outgoing> outgoing_;
};

struct Outcome {
  Pinger pinger;
  std::vector<DirectedDecision> decisions;
};

Outcome ping_pong(const char* profile, std::uint64_t seed, std::chrono::seconds length) {
  const auto loaded = load_profile(profile);
  EXPECT_TRUE(loaded.has_value());
  Outcome run;
  Echo echo;
  VirtualDriver driver(run.pinger, echo, *loaded, seed, Time{});
  driver.run_until(Time{length});
  EXPECT_EQ(driver.now(), Time{length});
  run.decisions = driver.emulator().take_decisions();
  return run;
}

TEST(VirtualDriver, EchoesComeBackAfterExactlyTheRoundTrip) {
  const Outcome run = ping_pong("paper-sas-20", 1, std::chrono::seconds(1));
  ASSERT_EQ(run.pinger.sent, 101) << "at 0, 10, ... 1000 ms";
  ASSERT_EQ(run.pinger.echoes.size(), 99U) << "the last two are on their way";
  for (std::size_t i = 0; i < run.pinger.echoes.size(); ++i) {
    EXPECT_EQ(run.pinger.echoes[i].first, static_cast<int>(i));
    EXPECT_EQ(run.pinger.echoes[i].second, Time{milliseconds(10) * static_cast<int>(i) + milliseconds(20)});
  }
  EXPECT_EQ(run.pinger.stream_octets, 99U);
}

TEST(VirtualDriver, EqualSeedsGiveEqualRuns) {
  const Outcome a = ping_pong("lossy-wifi", 4, std::chrono::seconds(5));
  const Outcome b = ping_pong("lossy-wifi", 4, std::chrono::seconds(5));
  EXPECT_EQ(a.decisions, b.decisions);
  EXPECT_EQ(a.pinger.echoes, b.pinger.echoes);
  EXPECT_LT(a.pinger.echoes.size(), 499U) << "a lossy profile";
  EXPECT_NE(ping_pong("lossy-wifi", 5, std::chrono::seconds(5)).decisions, a.decisions);
}

TEST(VirtualDriver, ScheduledCallsComeInOrderAndMaySchedule) {
  Pinger pinger;
  Echo echo;
  VirtualDriver driver(pinger, echo, *load_profile("lan"), 1, Time{});
  std::vector<std::pair<int, Time>> calls;
  driver.schedule(Time{milliseconds(7)}, [&](Time now) { calls.emplace_back(2, now); });
  driver.schedule(Time{milliseconds(3)}, [&](Time now) {
    calls.emplace_back(1, now);
    driver.schedule(Time{}, [&](Time late) { calls.emplace_back(3, late); });
  });
  driver.schedule(Time{milliseconds(7)}, [&](Time now) { calls.emplace_back(4, now); });
  driver.run_until(Time{milliseconds(6)});
  EXPECT_EQ(calls,
            (std::vector<std::pair<int, Time>>{{1, Time{milliseconds(3)}}, {3, Time{milliseconds(3)}}}));
  driver.run_until(Time{milliseconds(7)});
  ASSERT_EQ(calls.size(), 4U);
  EXPECT_EQ(calls[2], std::pair(2, Time{milliseconds(7)}));
  EXPECT_EQ(calls[3], std::pair(4, Time{milliseconds(7)}));
}

TEST(VirtualDriver, AnHourTakesNoHour) {
  const Time before = steady_now();
  const Outcome run = ping_pong("lte", 2, std::chrono::hours(1));
  EXPECT_GT(run.pinger.echoes.size(), 350'000U);
  EXPECT_LT(steady_now() - before, std::chrono::minutes(1)) << "a generous bound: seconds, on a free machine";
}

}  // namespace
}  // namespace atlaswire::netsim
