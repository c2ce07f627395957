#pragma once

#include "base/bytes.h"
#include "base/time.h"
#include "client/session.h"
#include "proto/datagram.h"
#include "proto/framing.h"
#include "proto/messages.h"
#include "proto/pose_packet.h"
#include "proto/rtcp.h"
#include "proto/rtp_sender.h"

#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

namespace atlaswire::client::testing {

/// A correct server, as far as a client can tell, in virtual time: answers the hello, challenges and
/// confirms the address, answers clock sync, and sends what the test asks it to. Its clock runs `kSkew`
/// ahead.
class FakeServer {
 public:
  static constexpr Duration kSkew = std::chrono::hours(7);
  static constexpr SessionId kSession{42};

  /// What leaves the server: on the reliable channel, and as datagrams.
  std::function<void(ByteBuffer)> send_stream;
  std::function<void(ByteBuffer)> send_datagram;

  proto::ServerHello answer = default_answer();
  bool answers = true;
  bool echoes_datagrams = true;

  std::optional<proto::ClientHello> hello;
  bool proven = false;
  std::vector<StampedPose> poses;  ///< newest of each packet
  std::vector<proto::StatsReport> reports;
  std::vector<proto::RestartRequest> restarts;
  std::vector<Emphasis> emphases;
  std::optional<proto::Goodbye> goodbye;
  int refresh_requests = 0;
  int receiver_reports = 0;

  static proto::ServerHello default_answer() {
    proto::ServerHello answer{.version = 1, .session = kSession, .udp_token = {}, .stream = {}};
    answer.udp_token.fill(std::byte{0x5A});
    answer.stream.scene = "atrium";
    answer.stream.picture = {256, 128};
    answer.stream.atlas = {256, 128};
    answer.stream.ssrc = 77;
    return answer;
  }

  void on_stream_bytes(ByteView bytes) {
    reader_.feed(bytes);
    while (true) {
      const auto frame = reader_.next();
      if (!frame || !*frame) return;
      const Result<proto::Message> message = proto::parse_message(**frame);
      if (message) on_message(*message);
    }
  }

  void on_datagram(ByteView datagram, Time now) {
    if (!echoes_datagrams) return;
    ByteBuffer out;
    switch (proto::classify(datagram)) {
      case proto::DatagramKind::kProbe:
        if (const auto probe = proto::parse_probe(datagram); probe && probe->token == answer.udp_token) {
          proto::encode(proto::Challenge{.session = kSession, .nonce = nonce_}, out);
          send_datagram(out);
        }
        return;
      case proto::DatagramKind::kConfirm:
        if (const auto confirm = proto::parse_confirm(datagram)) {
          proven = confirm->token == answer.udp_token && confirm->nonce == nonce_;
        }
        return;
      case proto::DatagramKind::kSyncRequest:
        if (const auto request = proto::parse_sync_request(datagram); request && proven) {
          proto::encode(proto::answer_sync(*request, now + kSkew, now + kSkew), out);
          send_datagram(out);
        }
        return;
      case proto::DatagramKind::kPose:
        if (const auto packet = proto::parse_pose_packet(datagram)) poses.push_back(packet->poses[0]);
        return;
      case proto::DatagramKind::kRtcp:
        return on_rtcp(datagram);
      default:
        return;
    }
  }

  void send(const proto::Message& message) {
    ByteBuffer out;
    proto::append_message(message, out);
    send_stream(std::move(out));
  }

  /// Sends frame `n`'s update and its picture of `octets` octets; datagrams for which `lost` says so do
  /// not leave.
  void send_frame(
      std::uint32_t n, bool idr, std::size_t octets, Time now,
      const std::function<bool(std::size_t)>& lost = [](std::size_t) { return false; }) {
    const Time server_now = now + kSkew;
    proto::FrameMeta meta{.frame = FrameId{n},
                          .pose = poses.empty() ? PoseId{} : poses.back().id,
                          .stamps = {server_now, server_now, server_now, server_now, server_now},
                          .cover = {},
                          .meta = ByteBuffer(100, std::byte{1})};
    send(meta);
    ByteBuffer unit{std::byte{0}, std::byte{0}, std::byte{0}, std::byte{1},
                    idr ? std::byte{0x65} : std::byte{0x41}};
    unit.resize(octets, std::byte{0x77});
    sender_.packetize(
        {.access_unit = unit, .frame = FrameId{n}, .pose = meta.pose, .capture = server_now, .idr = idr},
        batch_);
    for (std::size_t i = 0; i < batch_.size(); ++i) {
      if (!lost(i)) send_datagram(ByteBuffer(batch_[i].begin(), batch_[i].end()));
    }
  }

 private:
  void on_message(const proto::Message& message) {
    if (const auto* h = std::get_if<proto::ClientHello>(&message)) {
      hello = *h;
      if (answers) send(answer);
    }
    if (const auto* r = std::get_if<proto::StatsReport>(&message)) reports.push_back(*r);
    if (const auto* r = std::get_if<proto::RestartRequest>(&message)) restarts.push_back(*r);
    if (const auto* e = std::get_if<Emphasis>(&message)) emphases.push_back(*e);
    if (const auto* g = std::get_if<proto::Goodbye>(&message)) goodbye = *g;
  }

  void on_rtcp(ByteView datagram) {
    const auto packets = proto::parse_rtcp(datagram);
    if (!packets) return;
    for (const proto::RtcpPacket& packet : *packets) {
      if (std::holds_alternative<proto::PictureLoss>(packet)) ++refresh_requests;
      if (const auto* rr = std::get_if<proto::ReceiverReport>(&packet); rr && !rr->blocks.empty())
        ++receiver_reports;
    }
  }

  proto::FrameReader reader_{proto::kMaxEnvelope};
  proto::Nonce nonce_{std::byte{9}, std::byte{8}, std::byte{7}};
  proto::RtpSender sender_{proto::RtpSender::Settings{.ssrc = 77}};
  proto::DatagramBatch batch_;
};

/// A session and a fake server joined by a path of 10 ms each way, in virtual time.
class World {
  Time now_{std::chrono::seconds(100)};  // before the session, which it starts

 public:
  static constexpr Duration kDelay = std::chrono::milliseconds(10);

  FakeServer server;
  Session session;
  std::vector<proto::AssembledFrame> frames;
  std::vector<ArrivedUpdate> updates;
  bool server_is_there = true;  ///< false: nothing of the server leaves or arrives any more

  explicit World(const SessionSettings& settings = {}) : session(settings, now_) {
    server.send_stream = [this](ByteBuffer bytes) {
      if (server_is_there) later([this, bytes = std::move(bytes)] { session.on_stream_bytes(bytes, now_); });
    };
    server.send_datagram = [this](ByteBuffer bytes) {
      if (server_is_there) later([this, bytes = std::move(bytes)] { session.on_datagram(bytes, now_); });
    };
    flush();
  }

  [[nodiscard]] Time now() const { return now_; }

  /// Runs until `span` has passed.
  void run(Duration span) {
    const Time end = now_ + span;
    for (int steps = 0; steps < 1'000'000; ++steps) {
      const auto deadline = session.next_deadline();
      Time next = end;
      if (!events_.empty()) next = std::min(next, events_.begin()->first);
      if (deadline) next = std::min(next, std::max(*deadline, now_));
      now_ = std::max(now_, next);
      if (!events_.empty() && events_.begin()->first <= now_) {
        const auto action = std::move(events_.begin()->second);
        events_.erase(events_.begin());
        action();
      } else if (deadline && *deadline <= now_) {
        session.poll(now_);
        ++polls;
      } else {
        return;
      }
      flush();
    }
    stuck = true;
  }

  /// To the client as if the server had sent it.
  void datagram_to_client(ByteBuffer bytes) { server.send_datagram(std::move(bytes)); }

  /// Carries what the session wants sent to the server, and takes what it delivers.
  void flush() {
    if (ByteBuffer bytes = session.take_stream_bytes(); !bytes.empty()) {
      later([this, bytes = std::move(bytes)] {
        if (server_is_there) server.on_stream_bytes(bytes);
      });
    }
    while (auto datagram = session.pop_datagram()) {
      later([this, bytes = std::move(*datagram)] {
        if (server_is_there) server.on_datagram(bytes, now_);
      });
    }
    while (auto frame = session.pop_frame()) frames.push_back(std::move(*frame));
    while (auto update = session.pop_update()) updates.push_back(std::move(*update));
  }

  int polls = 0;
  bool stuck = false;  ///< the session kept asking for calls without time passing

 private:
  void later(std::function<void()> action) { events_.emplace(now_ + kDelay, std::move(action)); }

  std::multimap<Time, std::function<void()>> events_;
};

}  // namespace atlaswire::client::testing
