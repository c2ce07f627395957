#include "netsim/relay.h"

#include "base/program.h"
#include "netsim/decision_log.h"
#include "tests/netsim/loopback.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

namespace atlaswire::netsim {
namespace {

using Kind = LoopbackSocket::Kind;
using std::chrono::milliseconds;

/// Each test is a process of its own, and two may run at once.
std::string temporary(const std::string& name) {
  return testing::TempDir() + "netsim_relay_test_" + std::to_string(getpid()) + "_" + name;
}

/// A relay to `target` on a thread of its own.
class RunningRelay {
 public:
  RunningRelay(const std::string& profile, std::uint16_t target,
               const std::function<void(RelaySettings&)>& change = {})
      : relay_(settings(profile, target, change)), thread_([this] { relay_.run(); }) {}
  ~RunningRelay() { stop(); }
  [[nodiscard]] std::uint16_t port() const { return relay_.port(); }
  /// Ends it; what it did.
  const RelayStats& stop() {
    if (thread_.joinable()) {
      relay_.stop();
      thread_.join();
    }
    return relay_.stats();
  }

 private:
  static RelaySettings settings(const std::string& profile, std::uint16_t target,
                                const std::function<void(RelaySettings&)>& change) {
    RelaySettings s;
    s.profile = *load_profile(profile);
    s.target_host = "127.0.0.1";
    s.target_port = target;
    s.duration = std::chrono::seconds(60);
    if (change) change(s);
    return s;
  }

  Relay relay_;
  std::thread thread_;
};

TEST(Relay, DatagramsComeBackAfterTheRoundTripAndNoSooner) {
  EchoServer echo;
  RunningRelay relay("paper-sas-20", echo.port());
  const LoopbackSocket client(Kind::kUdp);
  ASSERT_TRUE(client.connect(relay.port()));
  Duration least = Duration::max();
  for (int i = 0; i < 10; ++i) {
    const ByteBuffer sent(static_cast<std::size_t>(100 * i), static_cast<std::byte>(i));
    const Time before = steady_now();
    ASSERT_TRUE(client.send(sent));
    EXPECT_EQ(client.receive(), sent);
    least = std::min(least, steady_now() - before);
  }
  EXPECT_GE(least, milliseconds(20));
  EXPECT_LT(least, milliseconds(200)) << "the quickest of ten; a busy machine may delay the others";
  const RelayStats& stats = relay.stop();
  EXPECT_EQ(stats.way(Direction::kUp).packets, 10U);
  EXPECT_EQ(stats.way(Direction::kDown).octets, 4500U);
  EXPECT_EQ(stats.udp_flows, 1U);
  EXPECT_EQ(stats.lateness.count(), 20U);
}

TEST(Relay, AFlowOfItsOwnForEachClient) {
  EchoServer echo;
  RunningRelay relay("paper-sas-0", echo.port(), [](RelaySettings& s) { s.max_flows = 2; });
  const LoopbackSocket clients[3] = {LoopbackSocket(Kind::kUdp), LoopbackSocket(Kind::kUdp),
                                     LoopbackSocket(Kind::kUdp)};
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(clients[i].connect(relay.port()));
    const ByteBuffer sent(10, static_cast<std::byte>(i));
    ASSERT_TRUE(clients[i].send(sent));
    if (i == 2) clients[i].limit_waiting(milliseconds(200));
    EXPECT_EQ(clients[i].receive().value_or(ByteBuffer{}), i < 2 ? sent : ByteBuffer{}) << i;
  }
  const RelayStats& stats = relay.stop();
  EXPECT_EQ(stats.udp_flows, 2U);
  EXPECT_EQ(stats.flows_refused, 1U);
}

TEST(Relay, AStreamArrivesWholeThroughLossesAndThenItsEnd) {
  EchoServer echo;
  RunningRelay relay("wifi5-crowded", echo.port());
  const LoopbackSocket client(Kind::kTcp);
  ASSERT_TRUE(client.connect(relay.port()));
  ByteBuffer sent(1'000'000);
  for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = static_cast<std::byte>(i * i >> 4U);
  std::thread sender([&] {
    EXPECT_TRUE(client.send(sent));
    client.end_sending();
  });
  ByteBuffer received;
  for (;;) {
    const auto part = client.receive();
    if (!part || part->empty()) {
      EXPECT_TRUE(part.has_value()) << "a clean end, not a reset and not silence";
      break;
    }
    received.insert(received.end(), part->begin(), part->end());
  }
  sender.join();
  EXPECT_TRUE(received == sent) << received.size();
  const RelayStats& stats = relay.stop();
  EXPECT_EQ(stats.tcp_connections, 1U);
  EXPECT_GT(stats.way(Direction::kUp).packets, 680U) << "in segments";
  const auto lost = [&](Direction d) { return stats.way(d).packets - stats.way(d).packets_by_fate[0]; };
  EXPECT_EQ(stats.stream_repeats, lost(Direction::kUp) + lost(Direction::kDown));
}

TEST(Relay, AStreamPaysForItsHandshake) {
  EchoServer echo;
  RunningRelay relay("paper-sas-100", echo.port());
  const LoopbackSocket client(Kind::kTcp);
  const Time before = steady_now();
  ASSERT_TRUE(client.connect(relay.port()));
  ASSERT_TRUE(client.send(ByteBuffer(10)));
  EXPECT_EQ(client.receive(), ByteBuffer(10));
  EXPECT_GE(steady_now() - before, milliseconds(200)) << "a round trip to connect, one for the echo";
}

TEST(Relay, ResetsTravelBothWays) {
  EchoServer echo;
  RunningRelay relay("lan", echo.port());
  LoopbackSocket client(Kind::kTcp);
  ASSERT_TRUE(client.connect(relay.port()));
  ASSERT_TRUE(client.send(ByteBuffer(10)));
  ASSERT_EQ(client.receive(), ByteBuffer(10));
  client.reset();
  const Time limit = steady_now() + std::chrono::seconds(20);
  while (echo.resets() == 0 && steady_now() < limit) std::this_thread::yield();
  EXPECT_EQ(echo.resets(), 1);

  const LoopbackSocket taken(Kind::kUdp);  // nobody has the TCP port of that number
  RunningRelay nowhere("lan", taken.bind_and_listen(Kind::kUdp));
  const LoopbackSocket hopeful(Kind::kTcp);
  ASSERT_TRUE(hopeful.connect(nowhere.port()));
  EXPECT_FALSE(hopeful.receive().has_value());
  EXPECT_EQ(errno, ECONNRESET);
  EXPECT_EQ(nowhere.stop().connect_failures, 1U);
}

std::vector<DirectedDecision> log_of(const std::string& name) {
  std::ifstream file(name);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto log = parse_decision_log(text);
  EXPECT_TRUE(log.has_value()) << log.error().message();
  return log.has_value() ? *log : std::vector<DirectedDecision>{};
}

/// Datagrams and a stream at once.
void run_live_and_replay(const Profile& profile) {
  const std::string log_file = temporary("log.csv");
  const std::string pcapng_file = temporary("log.pcapng");
  EchoServer echo;
  {
    RunningRelay relay("lossy-wifi", echo.port(), [&](RelaySettings& s) {
      s.profile = profile;
      s.seed = 77;
      s.log_file = log_file;
      s.pcapng_file = pcapng_file;
    });
    const LoopbackSocket media(Kind::kUdp);
    const LoopbackSocket control(Kind::kTcp);
    ASSERT_TRUE(media.connect(relay.port()));
    ASSERT_TRUE(control.connect(relay.port()));
    media.limit_waiting(milliseconds(1));
    control.limit_waiting(milliseconds(1));
    std::size_t echoed = 0;
    std::size_t streamed = 0;
    for (int i = 0; i < 40; ++i) {
      for (int j = 0; j < 20; ++j) ASSERT_TRUE(media.send(ByteBuffer(1000)));
      ASSERT_TRUE(control.send(ByteBuffer(2000)));
      while (media.receive()) ++echoed;
      while (control.receive()) ++streamed;
    }
    const RelayStats& stats = relay.stop();
    const auto& up = stats.way(Direction::kUp);
    EXPECT_GT(up.packets_by_fate[static_cast<std::size_t>(Fate::kLost)], 0U) << "5 % of 800 and more";
    EXPECT_GT(echoed, 0U);
    EXPECT_GT(streamed, 0U);
  }
  const auto log = log_of(log_file);
  EXPECT_GT(log.size(), 900U);
  EXPECT_EQ(std::any_of(log.begin(), log.end(), [](const auto& d) { return d.path == PathId{1}; }),
            profile.paths() > 1);
  EXPECT_TRUE(replay(log, profile, 77) == log);
  EXPECT_FALSE(replay(log, profile, 78) == log);
  EXPECT_GT(std::filesystem::file_size(pcapng_file), log.size() * 100);
}

TEST(Relay, ALiveLogReplaysIdenticallyInVirtualTime) { run_live_and_replay(*load_profile("lossy-wifi")); }

TEST(Relay, ALiveLogReplaysWhereStreamsHaveAPathOfTheirOwn) {
  const std::string text(shipped_profile_text("lossy-wifi"));
  run_live_and_replay(*parse_profile(text + "[[flow]]\nkind = \"stream\"\n", "apart", "."));
}

TEST(Relay, EcnBitsTravelBothWays) {
  EchoServer echo;
  RunningRelay relay("lan", echo.port());
  const LoopbackSocket client(Kind::kUdp);
  ASSERT_TRUE(client.connect(relay.port()));
  for (int bits = 0; bits < 4; ++bits) {
    client.send_with_ecn(bits);
    ASSERT_TRUE(client.send(ByteBuffer(10)));
    const auto answer = client.receive_with_ecn();
    ASSERT_TRUE(answer.has_value());
    EXPECT_EQ(answer->ecn, bits);
  }
}

TEST(Relay, AQueueThatMarksDropsNothingThatCanBeMarked) {
  const std::string log_file = temporary("marks.csv");
  const Profile profile = *parse_profile(
      "[up]\nrate = { mbps = 8 }\n"
      "queue = { policy = \"codel\", limit_kb = 1024, target_ms = 1, interval_ms = 10, ecn = true }\n",
      "marks", ".");
  EchoServer echo;
  RunningRelay relay("lan", echo.port(), [&](RelaySettings& s) {
    s.profile = profile;
    s.log_file = log_file;
  });
  const LoopbackSocket client(Kind::kUdp);
  ASSERT_TRUE(client.connect(relay.port()));
  constexpr int kPackets = 200;  // at once: a queue of 200 ms
  client.send_with_ecn(2);
  for (int i = 0; i < kPackets; ++i) ASSERT_TRUE(client.send(ByteBuffer(972)));
  int seen[4] = {};
  for (int i = 0; i < kPackets; ++i) {
    const auto answer = client.receive_with_ecn();
    ASSERT_TRUE(answer.has_value()) << i;
    ++seen[answer->ecn];
  }
  EXPECT_GT(seen[3], 0) << "congestion experienced";
  EXPECT_EQ(seen[2] + seen[3], kPackets);
  EXPECT_EQ(relay.stop().way(Direction::kUp).marked, static_cast<std::uint64_t>(seen[3]));
  const auto log = log_of(log_file);
  EXPECT_TRUE(replay(log, profile, 1) == log);
}

TEST(Relay, AFloodDoesNotHoldUpWhatIsDue) {
  const LoopbackSocket sink(Kind::kUdp);
  RunningRelay relay("paper-sas-0", sink.bind_and_listen(Kind::kUdp));
  const LoopbackSocket client(Kind::kUdp);
  ASSERT_TRUE(client.connect(relay.port()));
  const Duration flood = std::chrono::seconds(1);
  const Time end = steady_now() + flood;
  const ByteBuffer octets(100);
  while (steady_now() < end) ASSERT_TRUE(client.send(octets));
  const RelayStats& stats = relay.stop();
  EXPECT_GT(stats.lateness.count(), 1000U);
  EXPECT_LT(stats.lateness.most_us(), to_ms(flood) * 1e3 / 2) << "nothing left before the flood was over";
}

TEST(Relay, LosesWhatTheProfileLoses) {
  EchoServer echo;
  RunningRelay relay("paper-sas-0", echo.port(), [](RelaySettings& s) {
    s.profile.up.steps[0].parameters.loss = {.kind = LossModel::Kind::kPeriodic, .period = 4, .burst = 1};
  });
  const LoopbackSocket client(Kind::kUdp);
  ASSERT_TRUE(client.connect(relay.port()));
  for (int i = 0; i <= 100; ++i) {  // the last is answered, so that all are counted
    ASSERT_TRUE(client.send(ByteBuffer(8, static_cast<std::byte>(i))));
    if (i % 4 == 3) continue;
    EXPECT_EQ(client.receive(), ByteBuffer(8, static_cast<std::byte>(i)));
  }
  const RelayStats& stats = relay.stop();
  EXPECT_EQ(stats.way(Direction::kUp).packets_by_fate[static_cast<std::size_t>(Fate::kLost)], 25U);
  EXPECT_EQ(stats.way(Direction::kDown).packets, 76U);
}

}  // namespace
}  // namespace atlaswire::netsim
