#pragma once

#include "proto/datagram.h"
#include "proto/framing.h"
#include "proto/messages.h"
#include "proto/pose_packet.h"
#include "proto/rtcp.h"
#include "server/session.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace atlaswire::server {

using namespace std::chrono_literals;

/// A session in virtual time with a well-behaved client's messages at hand.
class SessionTest : public ::testing::Test {
 protected:
  SessionTest() {
    settings.bit_rate.bits_per_second = 8'000'000;
    settings.delivery.pacing = 2.5;
  }

  Session& start() {
    SessionKeys keys;
    keys.id = SessionId{7};
    keys.token.fill(std::byte{0x5A});
    keys.ssrc = 0x1234;
    session = std::make_unique<Session>(
        settings, keys,
        [this] {
          proto::Nonce nonce{};
          nonce[0] = static_cast<std::byte>(++nonces);
          return nonce;
        },
        now);
    return *session;
  }

  void feed(const proto::Message& message) {
    ByteBuffer bytes;
    proto::append_message(message, bytes);
    session->on_stream_bytes(bytes, now);
  }

  /// Every message that the session has put on TCP, taking it.
  std::vector<proto::Message> replies() {
    proto::FrameReader reader(proto::kMaxEnvelope);
    std::vector<proto::Message> messages;
    while (!session->stream_output().empty()) {
      const ByteView out = session->stream_output();
      reader.feed(out);
      session->stream_sent(out.size(), now);
      for (auto next = reader.next(); next && *next; next = reader.next()) {
        messages.push_back(proto::parse_message(**next).value());
      }
    }
    return messages;
  }

  struct Sent {
    proto::PeerAddress to;
    ByteBuffer bytes;
    bool media = false;
  };
  std::vector<Sent> datagrams() {
    std::vector<Sent> all;
    while (const auto out = session->next_datagram(now)) {
      all.push_back({out->to, ByteBuffer(out->bytes.begin(), out->bytes.end()), out->media});
    }
    return all;
  }

  static proto::StreamDescription stream() {
    proto::StreamDescription d;
    d.scene = "test";
    d.picture = d.atlas = {256, 256};
    return d;
  }

  void greet() {
    feed(proto::ClientHello{});
    ASSERT_EQ(session->state(), SessionState::kHelloReceived);
    session->accept(stream(), now);
    const auto answer = replies();
    ASSERT_EQ(answer.size(), 1U);
    hello = std::get<proto::ServerHello>(answer[0]);
  }

  template <class Message>
  void send(const Message& message, const proto::PeerAddress& from) {
    ByteBuffer bytes;
    encode(message, bytes);
    session->on_datagram(from, bytes, now);
  }

  /// The nonce of the one challenge that goes to `to`.
  proto::Nonce challenged(const proto::PeerAddress& to) {
    const auto out = datagrams();
    EXPECT_EQ(out.size(), 1U);
    if (out.empty()) return {};
    EXPECT_EQ(out[0].to, to);
    return proto::parse_challenge(out[0].bytes).value().nonce;
  }

  void prove(const proto::PeerAddress& address) {
    send(proto::Probe{hello.session, hello.udp_token}, address);
    send(proto::Confirm{hello.session, hello.udp_token, challenged(address)}, address);
  }

  void stream_to(const proto::PeerAddress& address) {
    start();
    greet();
    prove(address);
    ASSERT_EQ(session->state(), SessionState::kStreaming);
  }

  void send_pose(std::uint32_t id, const proto::PeerAddress& from) {
    proto::PosePacket packet;
    packet.session = hello.session;
    packet.count = 1;
    packet.poses[0].id = PoseId{id};
    send(packet, from);
  }

  void send_rtcp(const std::vector<proto::RtcpPacket>& packets, const proto::PeerAddress& from) {
    ByteBuffer bytes;
    proto::encode_rtcp(packets, bytes);
    session->on_datagram(from, bytes, now);
  }

  /// A frame of `octets` of one NAL unit.
  static FramePtr frame(std::uint32_t id, std::size_t octets, bool idr, std::size_t meta_octets = 10) {
    auto f = std::make_shared<EncodedFrame>();
    f->frame = FrameId{id};
    f->pose = PoseId{1};
    f->idr = idr;
    f->video.assign(octets, std::byte{0x11});
    const std::byte start[] = {std::byte{0}, std::byte{0}, std::byte{0}, std::byte{1},
                               std::byte{idr ? std::uint8_t{0x65} : std::uint8_t{0x41}}};
    std::copy(std::begin(start), std::end(start), f->video.begin());
    f->meta.assign(meta_octets, std::byte{0x22});
    return f;
  }

  /// Runs the session's own deadlines until `end`; gives the datagrams it sent.
  std::vector<Sent> run_until(Time end) {
    std::vector<Sent> all;
    for (;;) {
      for (auto& sent : datagrams()) all.push_back(std::move(sent));
      const auto due = session->next_deadline();
      if (!due || *due > end) break;
      now = std::max(now + 1us, *due);
      session->poll(now);
    }
    now = end;
    session->poll(now);
    for (auto& sent : datagrams()) all.push_back(std::move(sent));
    return all;
  }

  SessionSettings settings;
  Time now = from_nanos(1'000'000'000);
  std::unique_ptr<Session> session;
  proto::ServerHello hello;
  unsigned nonces = 0;
  const proto::PeerAddress home = proto::ipv4_address({10, 0, 0, 1}, 5000);
  const proto::PeerAddress away = proto::ipv4_address({10, 9, 9, 9}, 6000);
};

}  // namespace atlaswire::server
