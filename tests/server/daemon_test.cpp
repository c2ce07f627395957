#include "server/daemon.h"

#include "base/program.h"
#include "proto/rtp.h"
#include "render/image/png.h"
#include "tests/server/daemon_fixture.h"
#include "tests/server/fake_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

namespace atlaswire::server {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

DaemonSettings quick_settings() {
  DaemonSettings settings;
  settings.stream.max_fps = 60;
  settings.stream.video.bit_rate.bits_per_second = 50'000'000;
  return settings;
}

TEST(Daemon, StreamsToTwoClientsAtOnce) {
  FakeSource source;
  RunningDaemon daemon(quick_settings(), source);
  RawClient a(daemon.port());
  RawClient b(daemon.port());
  ASSERT_TRUE(a.run_until_frames(10, 20s));
  ASSERT_TRUE(b.run_until_frames(10, 20s));
  EXPECT_NE(a.hello()->session, b.hello()->session);
  EXPECT_NE(a.hello()->stream.ssrc, b.hello()->stream.ssrc);
  EXPECT_NE(a.hello()->udp_token, b.hello()->udp_token);
}

TEST(Daemon, RendersForBothEyesOfAStereoClient) {
  FakeSource source;
  RunningDaemon daemon(quick_settings(), source);
  proto::ClientHello hello;
  hello.eye_separation = 0.07;
  RawClient stereo(daemon.port(), hello);
  ASSERT_TRUE(stereo.run_until_frames(2, 20s));
  EXPECT_EQ(source.watch.eye_separation, 0.07);
}

TEST(Daemon, RefusesBeyondItsCapacityAndServesTheRest) {
  FakeSource source;
  auto settings = quick_settings();
  settings.admission.max_sessions = 1;
  RunningDaemon daemon(settings, source);
  RawClient first(daemon.port());
  ASSERT_TRUE(first.run_until_frames(2, 20s));
  RawClient second(daemon.port());
  ASSERT_TRUE(second.run_until([&] { return second.refusal().has_value(); }, 20s));
  EXPECT_EQ(second.refusal()->code, proto::Refusal::Code::kCapacity);
  EXPECT_TRUE(first.run_until_frames(first.paired() + 5, 20s));
}

TEST(Daemon, TellsAllAnewToAClientThatIsOutOfStep) {
  FakeSource source;
  RunningDaemon daemon(quick_settings(), source);
  RawClient client(daemon.port());
  ASSERT_TRUE(client.run_until_frames(3, 20s));
  EXPECT_EQ(source.watch.restarts, 1U);
  client.send(proto::RestartRequest{FrameId{2}, "bent"});
  EXPECT_TRUE(client.run_until([&] { return source.watch.restarts == 2; }, 20s));
  EXPECT_TRUE(client.run_until_frames(client.paired() + 3, 20s));
  EXPECT_FALSE(client.goodbye());
}

TEST(Daemon, ClosesConnectionsBeyondItsLimitPerAddress) {
  FakeSource source;
  auto settings = quick_settings();
  settings.admission.max_connections_per_address = 2;
  RunningDaemon daemon(settings, source);
  const RawSocket a(SOCK_STREAM, daemon.port());
  const RawSocket b(SOCK_STREAM, daemon.port());
  RawSocket c(SOCK_STREAM, daemon.port());
  ASSERT_TRUE(c.wait(20s));
  c.receive();
  EXPECT_TRUE(c.ended());
}

TEST(Daemon, GarbageAndSilenceHarmNobody) {
  FakeSource source;
  auto settings = quick_settings();
  settings.admission.hello_timeout = 300ms;
  RunningDaemon daemon(settings, source);
  RawClient client(daemon.port());
  ASSERT_TRUE(client.run_until_frames(3, 20s));

  RawSocket silent(SOCK_STREAM, daemon.port());
  RawSocket garbage(SOCK_STREAM, daemon.port());
  garbage.send(ByteBuffer(5000, std::byte{0xEE}));
  RawSocket flood(SOCK_DGRAM, daemon.port());
  std::size_t sent = 0;
  const auto goal = client.paired() + 20;
  ASSERT_TRUE(client.run_until(
      [&] {
        for (int i = 0; i < 50; ++i) {
          flood.send(ByteBuffer(sent % 1400 + 1, static_cast<std::byte>(sent * 7)));
          ++sent;
        }
        return client.paired() >= goal;
      },
      20s));
  EXPECT_GT(sent, 1000U);
  ASSERT_TRUE(garbage.wait(20s));
  garbage.receive();
  ASSERT_TRUE(silent.wait(20s)) << "the hello timeout ends it";
  EXPECT_TRUE(client.run_until_frames(client.paired() + 5, 20s));
  EXPECT_FALSE(client.goodbye());
}

TEST(Daemon, AClientThatVanishesLeavesTheOtherAlone) {
  FakeSource source;
  RunningDaemon daemon(quick_settings(), source);
  RawClient client(daemon.port());
  {
    RawClient doomed(daemon.port());
    ASSERT_TRUE(doomed.run_until_frames(2, 20s));
  }
  ASSERT_TRUE(client.run_until_frames(20, 20s));
  daemon.stop();
  EXPECT_EQ(source.given_back, 2U);
}

TEST(Daemon, AFailedStreamEndsItsSessionOnly) {
  FakeSource source;
  RunningDaemon daemon(quick_settings(), source);
  RawClient lucky(daemon.port());
  ASSERT_TRUE(lucky.run_until_frames(10, 20s));
  source.watch.fail_render_at = 5;  // the first stream is past it
  RawClient unlucky(daemon.port());
  ASSERT_TRUE(unlucky.run_until([&] { return unlucky.goodbye().has_value(); }, 20s));
  EXPECT_EQ(unlucky.goodbye()->reason, proto::Goodbye::Reason::kInternal);
  EXPECT_THAT(unlucky.goodbye()->text, HasSubstr("device lost"));
  EXPECT_TRUE(lucky.run_until_frames(lucky.paired() + 5, 20s));
}

TEST(Daemon, PictureLossBringsAnIntraFrame) {
  FakeSource source;
  RunningDaemon daemon(quick_settings(), source);
  RawClient client(daemon.port());
  ASSERT_TRUE(client.run_until_frames(2, 20s));
  const std::uint32_t intra = source.watch.intra;
  const std::uint32_t rendered = source.watch.rendered;
  client.lose_picture();
  ASSERT_TRUE(client.run_until([&] { return source.watch.rendered >= rendered + 10; }, 20s));
  EXPECT_GE(source.watch.intra - intra, 3U) << "two by rule in ten frames, one for the loss";
}

TEST(Daemon, AClientsEmphasisReachesItsStreamOverTheOperators) {
  FakeSource source;
  auto settings = quick_settings();
  settings.stream.render.emphasis = {.foveation = 0.5, .priorities = {{"floor", -1}}};
  RunningDaemon daemon(settings, source);
  RawClient client(daemon.port());
  ASSERT_TRUE(client.run_until_frames(2, 20s));
  EXPECT_EQ(source.watch.foveation, 0.5);
  EXPECT_EQ(source.watch.emphases, 1U) << "told with the first frame only";
  client.send(Emphasis{.priorities = {{"lamp", 3}}});
  ASSERT_TRUE(client.run_until([&] { return source.watch.priorities == 2U; }, 20s));
  EXPECT_EQ(source.watch.foveation, 0.5) << "no opinion leaves the operator's";
  client.send(Emphasis{.foveation = 2.0});
  ASSERT_TRUE(client.run_until([&] { return source.watch.foveation == 2.0; }, 20s));
  EXPECT_EQ(source.watch.priorities, 1U) << "the one before is gone as a whole";
  EXPECT_FALSE(client.is_closed());
}

TEST(Daemon, ReloadsTheOperatorsEmphasisIntoRunningStreams) {
  FakeSource source;
  std::atomic<int> calls{0};
  RunningDaemon daemon(quick_settings(), source, [&]() -> Emphasis {
    if (++calls == 1) return {.foveation = 3.0};
    throw ProgramError(ExitCode::kUsage, "--foveation 9: must be 0..8");
  });
  RawClient client(daemon.port());
  ASSERT_TRUE(client.run_until_frames(2, 20s));
  client.send(Emphasis{.priorities = {{"lamp", 3}}});
  daemon.reload();
  ASSERT_TRUE(
      client.run_until([&] { return source.watch.foveation == 3.0 && source.watch.priorities == 1U; }, 20s));
  daemon.reload();
  ASSERT_TRUE(client.run_until([&] { return calls == 2; }, 20s));
  const auto frames = client.paired();
  ASSERT_TRUE(client.run_until_frames(frames + 2, 20s)) << "a bad file leaves everything as it is";
  EXPECT_EQ(source.watch.foveation, 3.0);
}

TEST(Daemon, DrawsTheLayoutOfARunningStreamWhenAsked) {
  FakeSource source;
  auto settings = quick_settings();
  settings.layout_picture = ::testing::TempDir() + "daemon_test_layout.png";
  std::filesystem::remove(settings.layout_picture);
  RunningDaemon daemon(settings, source);
  daemon.draw_layout();  // nobody streams: a warning
  RawClient client(daemon.port());
  ASSERT_TRUE(client.run_until_frames(2, 20s));
  EXPECT_FALSE(std::filesystem::exists(settings.layout_picture));
  daemon.draw_layout();
  ASSERT_TRUE(client.run_until([&] { return std::filesystem::exists(settings.layout_picture); }, 20s));
  const auto drawn = render::read_png(settings.layout_picture);
  ASSERT_TRUE(drawn.has_value());
  EXPECT_EQ(drawn->extent, (Extent2D{8, 8}));
  std::filesystem::remove(settings.layout_picture);
}

TEST(Daemon, DrainSaysGoodbyeToAll) {
  FakeSource source;
  RunningDaemon daemon(quick_settings(), source);
  RawClient client(daemon.port());
  ASSERT_TRUE(client.run_until_frames(2, 20s));
  RawSocket silent(SOCK_STREAM, daemon.port());
  daemon.request_stop();
  ASSERT_TRUE(client.run_until([&] { return client.goodbye().has_value(); }, 20s));
  EXPECT_EQ(client.goodbye()->reason, proto::Goodbye::Reason::kDraining);
  daemon.stop();
  EXPECT_TRUE(silent.wait(1s));
}

TEST(Daemon, MaxRuntimeDrains) {
  FakeSource source;
  auto settings = quick_settings();
  settings.max_runtime = 200ms;
  settings.port = 0;
  Daemon daemon(settings);
  const Time begun = steady_now();
  daemon.serve(source);
  EXPECT_GE(steady_now() - begun, Duration{200ms});
}

TEST(Daemon, MirrorGetsTheFirstStreamsPackets) {
  FakeSource source;
  const int receiver = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  ASSERT_EQ(::bind(receiver, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(::getsockname(receiver, reinterpret_cast<sockaddr*>(&address), &size), 0);
  auto settings = quick_settings();
  settings.mirror = HostPort{"localhost", ntohs(address.sin_port)};
  settings.mirror->host = "127.0.0.1";
  RunningDaemon daemon(settings, source);
  RawClient client(daemon.port());
  ASSERT_TRUE(client.run_until_frames(5, 20s));
  std::byte packet[2000];
  const auto octets = ::recv(receiver, packet, sizeof(packet), 0);
  ASSERT_GT(octets, 12);
  const auto rtp = proto::parse_rtp(ByteView(packet, static_cast<std::size_t>(octets))).value();
  EXPECT_EQ(rtp.header.ssrc, client.hello()->stream.ssrc);
  ::close(receiver);
}

TEST(Daemon, StatsCsvHasALinePerFrame) {
  FakeSource source;
  auto settings = quick_settings();
  settings.stats_csv = ::testing::TempDir() + "atlasd_stats_test.csv";
  {
    RunningDaemon daemon(settings, source);
    RawClient client(daemon.port());
    ASSERT_TRUE(client.run_until_frames(5, 20s));
  }
  std::ifstream file(settings.stats_csv);
  std::string header;
  std::getline(file, header);
  const auto columns = std::count(header.begin(), header.end(), ',');
  std::size_t lines = 0;
  for (std::string line; std::getline(file, line); ++lines) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns) << line;
  }
  EXPECT_GE(lines, 5U);
  std::remove(settings.stats_csv.c_str());
}

TEST(DaemonStart, APortInUseIsNamedWithItsCure) {
  auto settings = quick_settings();
  settings.port = 0;
  const Daemon first(settings);
  settings.port = first.port();
  try {
    const Daemon second(settings);
    FAIL() << "took the port twice";
  } catch (const ProgramError& e) {
    EXPECT_EQ(e.code(), ExitCode::kPortInUse);
    EXPECT_THAT(e.what(), HasSubstr("choose another --port"));
  }
}

TEST(DaemonStart, AddressesThatAreNoneAreUsageErrors) {
  auto settings = quick_settings();
  settings.listen = "everywhere";
  try {
    const Daemon daemon(settings);
    FAIL() << "listens everywhere";
  } catch (const ProgramError& e) {
    EXPECT_EQ(e.code(), ExitCode::kUsage);
  }
}

}  // namespace
}  // namespace atlaswire::server
