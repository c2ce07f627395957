#pragma once

#include "base/bytes.h"
#include "base/pose.h"
#include "base/time.h"
#include "client/session_end.h"
#include "client/session_types.h"
#include "client/traffic.h"
#include "proto/clock_sync.h"
#include "proto/frame_assembler.h"
#include "proto/framing.h"
#include "proto/messages.h"
#include "proto/pose_packet.h"
#include "proto/refresh_timer.h"
#include "proto/rtcp_stats.h"
#include "proto/udp_greeter.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

namespace atlaswire::client {

/// A client's session, without sockets, threads or a clock: bytes, datagrams and `now` go in; bytes,
/// datagrams, access units and meta updates come out (docs/PROTOCOL.md, section "Session life"). Send what
/// `take_stream_bytes` and `pop_datagram` give after every call, and call `poll` at `next_deadline`.
/// Safe on hostile input: whatever breaks the reliable channel's rules ends the session with a Goodbye that
/// says why; datagrams that do not belong are counted and ignored. `now` must never decrease.
class Session {
 public:
  Session(const SessionSettings& settings, Time now);

  void on_stream_bytes(ByteView bytes, Time now);
  void on_stream_closed(Time now);
  void on_datagram(ByteView datagram, Time now);
  /// The newest pose: numbered and sent with the two before it. nullopt before the handshake ended and after
  /// the end.
  std::optional<PoseId> on_pose(const Pose& pose, Time sampled);
  /// How the server is to share out our stream's atlas, by the rules of proto::parse_message: said at `at`,
  /// or by the first poll after the handshake, in place of all that was said before.
  void set_emphasis(Emphasis emphasis, Time at);
  /// The decoder gave up: frames are withheld until an IDR, which is asked for.
  void on_decode_failed();
  void set_progress(const Progress& progress) { progress_ = progress; }
  /// What the viewer knows has come apart from what the server tells: asks for all anew.
  void request_restart(FrameId frame, const std::string& why);
  /// The viewer found the server to break the protocol (a replica that cannot be updated, say).
  void fail(const std::string& why);
  /// The viewer has seen enough: says Goodbye and ends.
  void finish();
  void poll(Time now);
  /// When to call `poll` next; nullopt once ended.
  [[nodiscard]] std::optional<Time> next_deadline() const;

  /// Bytes for the reliable channel since the last call.
  ByteBuffer take_stream_bytes();
  std::optional<ByteBuffer> pop_datagram();
  std::optional<proto::AssembledFrame> pop_frame();
  std::optional<ArrivedUpdate> pop_update();

  /// The server's answer; nullopt until it came.
  [[nodiscard]] const std::optional<proto::ServerHello>& answer() const { return answer_; }
  /// Why the session is over; nullopt while it is not.
  [[nodiscard]] const std::optional<SessionEnd>& end() const { return end_; }
  [[nodiscard]] bool is_udp_established() const { return media_ && media_->greeter.is_established(); }
  /// nullopt before the handshake ended.
  [[nodiscard]] const proto::ClockSync* clock() const { return media_ ? &media_->clock : nullptr; }
  [[nodiscard]] const Traffic& traffic() const { return traffic_; }
  [[nodiscard]] PacketCounts packets() const;
  [[nodiscard]] proto::AssemblerCounts frames() const;

 private:
  /// What exists once the server has accepted us.
  struct Media {
    Media(const proto::ServerHello& answer, const SessionSettings& settings);
    proto::UdpGreeter greeter;
    proto::ClockSync clock;
    proto::PoseOutbox poses;
    proto::FrameAssembler assembler;
    proto::ReceptionStats reception;
    proto::RefreshTimer refresh;
  };

  void on_message(proto::Message&& message, std::size_t octets, Time now);
  void on_answer(const proto::ServerHello& answer, Time now);
  void on_rtp(ByteView datagram, Time now);
  void on_rtcp(ByteView datagram, Time now);
  void on_challenge(ByteView datagram, Time now);
  void on_sync_response(ByteView datagram, Time now);
  void accept_datagram(Time now);
  void refuse_datagram(ByteView datagram);
  void tell_emphasis(Time now);
  void send_message(const proto::Message& message);
  void send_datagram(ByteBuffer datagram, std::uint64_t& channel);
  void send_report(Time now);
  void send_refresh_request();
  void check_patience(Time now);
  void drain_assembler();
  void end_with(SessionEnd::Kind kind, std::string text);
  void break_off(const std::string& why);

  SessionSettings settings_;
  proto::FrameReader reader_;
  Time started_;
  Time last_heard_;
  std::optional<Time> media_due_;  ///< the first datagram must have come by then
  Time next_report_{};
  std::optional<proto::ServerHello> answer_;
  std::optional<Media> media_;
  std::optional<SessionEnd> end_;
  std::optional<Emphasis> emphasis_;  ///< not said yet
  Time emphasis_due_{};
  Progress progress_;
  Traffic traffic_;
  PacketCounts packets_;
  ByteBuffer stream_out_;
  std::deque<ByteBuffer> datagrams_out_;
  std::deque<proto::AssembledFrame> frames_;
  std::deque<ArrivedUpdate> updates_;
};

}  // namespace atlaswire::client
