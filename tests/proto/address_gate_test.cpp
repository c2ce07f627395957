#include "proto/address_gate.h"

#include "proto/datagram.h"
#include "proto/udp_greeter.h"
#include "tests/proto/vocabulary.h"

#include <gtest/gtest.h>

namespace atlaswire::proto {
namespace {

using test::at;
using namespace std::chrono_literals;

UdpToken secret(unsigned v) {
  UdpToken out{};
  out.fill(static_cast<std::byte>(v));
  return out;
}

const UdpToken kToken = secret(7);
const PeerAddress kHome = ipv4_address({10, 0, 0, 1}, 5000);
const PeerAddress kAway = ipv4_address({10, 0, 0, 2}, 5000);

TEST(AddressGate, AProbeIsChallengedAndItsEchoProvesTheAddress) {
  AddressGate gate(kToken);
  const auto nonce = gate.on_datagram(kHome, kProbeSize, kToken, secret(1), at(0s));
  ASSERT_TRUE(nonce);
  EXPECT_FALSE(gate.media_address());
  EXPECT_FALSE(gate.is_proven(kHome));
  EXPECT_TRUE(gate.on_confirm(kHome, kConfirmSize, kToken, *nonce, at(10ms)));
  EXPECT_EQ(gate.media_address(), kHome);
  EXPECT_TRUE(gate.is_proven(kHome));
  EXPECT_FALSE(gate.is_proven(kAway));
}

TEST(AddressGate, WrongTokensGetNothing) {
  AddressGate gate(kToken);
  EXPECT_FALSE(gate.on_datagram(kHome, kProbeSize, secret(8), secret(1), at(0s)));
  const auto nonce = gate.on_datagram(kHome, kProbeSize, kToken, secret(1), at(0s));
  EXPECT_FALSE(gate.on_confirm(kHome, kConfirmSize, secret(8), *nonce, at(0s)));
  EXPECT_FALSE(gate.media_address());
}

TEST(AddressGate, WrongNoncesAndUnaskedConfirmsProveNothing) {
  AddressGate gate(kToken);
  EXPECT_FALSE(gate.on_confirm(kHome, kConfirmSize, kToken, secret(1), at(0s)));
  EXPECT_TRUE(gate.on_datagram(kHome, kProbeSize, kToken, secret(1), at(0s)));
  EXPECT_FALSE(gate.on_confirm(kHome, kConfirmSize, kToken, secret(2), at(0s)));
  EXPECT_FALSE(gate.on_confirm(kAway, kConfirmSize, kToken, secret(1), at(0s)));  // seen on another path
  EXPECT_FALSE(gate.media_address());
}

TEST(AddressGate, RepeatedProbesGetTheSameNonceWhileItLives) {
  AddressGate gate(kToken);
  const auto first = gate.on_datagram(kHome, kProbeSize, kToken, secret(1), at(0s));
  EXPECT_EQ(gate.on_datagram(kHome, kProbeSize, kToken, secret(2), at(1s)), first);
  EXPECT_EQ(gate.on_datagram(kHome, kProbeSize, kToken, secret(3), at(6s)), secret(3));
  EXPECT_FALSE(gate.on_confirm(kHome, kConfirmSize, kToken, *first, at(6s)));
}

TEST(AddressGate, AnOldNonceIsWorthless) {
  AddressGate gate(kToken);
  const auto nonce = gate.on_datagram(kHome, kProbeSize, kToken, secret(1), at(0s));
  EXPECT_FALSE(gate.on_confirm(kHome, kConfirmSize, kToken, *nonce, at(11s)));
}

TEST(AddressGate, NeverSendsMoreThanThreeTimesWhatItReceived) {
  AddressGate gate(kToken);
  Random random(3);
  std::uint64_t received = 0;
  std::uint64_t sent = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::size_t octets = 1 + random.below(20);
    received += octets;
    if (gate.on_datagram(kHome, octets, std::nullopt, secret(1), at(1ms * i))) sent += kChallengeSize;
    ASSERT_LE(sent, 3 * received);
  }
  EXPECT_GT(sent, 0U);
}

TEST(AddressGate, AClientThatRoamsMustProveItsNewAddress) {
  AddressGate gate(kToken);
  const auto home = gate.on_datagram(kHome, kProbeSize, kToken, secret(1), at(0s));
  gate.on_confirm(kHome, kConfirmSize, kToken, *home, at(0s));
  // Poses come from elsewhere now: no token in them, but enough octets for a challenge.
  const auto away = gate.on_datagram(kAway, 235, std::nullopt, secret(2), at(1s));
  ASSERT_TRUE(away);
  EXPECT_EQ(gate.media_address(), kHome);
  EXPECT_TRUE(gate.on_confirm(kAway, kConfirmSize, kToken, *away, at(1s)));
  EXPECT_EQ(gate.media_address(), kAway);
  EXPECT_FALSE(gate.is_proven(kHome));
}

TEST(AddressGate, AFloodOfStrangersCannotPushOutWhoeverShowsTheToken) {
  AddressGate gate(kToken);
  const auto nonce = gate.on_datagram(kHome, kProbeSize, kToken, secret(1), at(0s));
  for (std::uint16_t port = 1; port < 2000; ++port) {
    gate.on_datagram(ipv4_address({1, 2, 3, 4}, port), 500, std::nullopt, secret(9), at(1ms * port));
  }
  EXPECT_TRUE(gate.on_confirm(kHome, kConfirmSize, kToken, *nonce, at(2s)));
}

TEST(AddressGate, StrangersReplaceStrangersAndNeverFourWhoShowTheToken) {
  AddressGate gate(kToken);
  const auto stranger = [](std::uint16_t port) { return ipv4_address({1, 2, 3, 4}, port); };
  ASSERT_TRUE(gate.on_datagram(kHome, kProbeSize, kToken, secret(1), at(0s)));
  for (std::uint16_t port = 1; port < 10; ++port) {
    EXPECT_TRUE(gate.on_datagram(stranger(port), 500, std::nullopt, secret(9), at(1s * port))) << port;
  }
  for (std::uint16_t port = 21; port < 24; ++port) {
    ASSERT_TRUE(gate.on_datagram(stranger(port), kProbeSize, kToken, secret(2), at(10s)));
  }
  EXPECT_FALSE(gate.on_datagram(stranger(30), 500, std::nullopt, secret(9), at(10s)));
  EXPECT_TRUE(gate.on_confirm(kHome, kConfirmSize, kToken, secret(1), at(10s)));
}

TEST(UdpGreeter, ProbesUntilSomethingComesBack) {
  UdpGreeter greeter(SessionId{3}, kToken);
  EXPECT_EQ(greeter.poll(at(0s)).value().token, kToken);
  EXPECT_FALSE(greeter.poll(at(99ms)));
  EXPECT_EQ(greeter.next_deadline(), at(100ms));
  EXPECT_TRUE(greeter.poll(at(100ms)));
  greeter.on_received(at(150ms));
  EXPECT_TRUE(greeter.is_established());
  EXPECT_FALSE(greeter.poll(at(1s)));
  EXPECT_TRUE(greeter.poll(at(2150ms)));
  EXPECT_FALSE(greeter.is_established());
}

TEST(UdpGreeter, AnswersChallengesOfItsOwnSessionOnly) {
  const UdpGreeter greeter(SessionId{3}, kToken);
  EXPECT_FALSE(greeter.on_challenge({SessionId{4}, secret(1)}));
  const auto confirm = greeter.on_challenge({SessionId{3}, secret(1)});
  ASSERT_TRUE(confirm);
  EXPECT_EQ(confirm->token, kToken);
  EXPECT_EQ(confirm->nonce, secret(1));
}

TEST(UdpGreeter, MeetsTheGateOverALossyPath) {
  Random random(5);
  AddressGate gate(kToken);
  UdpGreeter greeter(SessionId{3}, kToken);
  const auto arrives = [&] { return random.uniform() > 0.6; };
  for (int i = 0; i < 500 && !gate.media_address(); ++i) {
    const Time now = at(10ms * i);
    const auto probe = greeter.poll(now);
    if (!probe || !arrives()) continue;
    const auto nonce = gate.on_datagram(kHome, kProbeSize, probe->token, secret(1), now);
    if (!nonce || !arrives()) continue;
    const auto confirm = greeter.on_challenge({SessionId{3}, *nonce});
    if (arrives()) gate.on_confirm(kHome, kConfirmSize, confirm->token, confirm->nonce, now);
  }
  EXPECT_EQ(gate.media_address(), kHome);
}

}  // namespace
}  // namespace atlaswire::proto
