#pragma once

#include "base/ids.h"
#include "codec/meta_update.h"
#include "proto/address_gate.h"
#include "proto/framing.h"
#include "proto/messages.h"
#include "proto/pose_inbox.h"
#include "proto/rtcp.h"
#include "server/media_outbox.h"
#include "server/reliable_outbox.h"
#include "server/settings.h"

#include <array>
#include <deque>
#include <functional>
#include <optional>
#include <string>

namespace atlaswire::server {

/// Numbers of one session that nobody may guess, from a cryptographic generator.
struct SessionKeys {
  SessionId id{};  ///< not 0
  proto::UdpToken token{};
  std::uint32_t ssrc = 1;
  std::uint16_t first_sequence = 0;
  std::uint32_t timestamp_base = 0;
};

struct SessionSettings {
  AdmissionSettings admission;
  DeliverySettings delivery;
  BitRate bit_rate;  ///< of the video; 0: constant quality, unpaced
};

/// Life of a session, in this order; docs/PROTOCOL.md, "Session life".
enum class SessionState : std::uint8_t {
  kWaitingHello,    ///< connected
  kHelloReceived,   ///< the owner must accept() or refuse()
  kWaitingAddress,  ///< ServerHello sent; the UDP address is unproven
  kStreaming,
  kClosing,  ///< last words are leaving on TCP
  kClosed
};

/// What a session counted.
struct SessionCounts {
  std::uint64_t frames = 0;          ///< delivered to its queues
  std::uint64_t frames_dropped = 0;  ///< pictures that did not fit
  std::uint64_t video_bytes = 0;     ///< access units
  std::uint64_t meta_bytes = 0;
  std::uint64_t picture_losses = 0;     ///< PLIs
  std::uint64_t restarts = 0;           ///< asked for
  std::uint64_t ignored_datagrams = 0;  ///< malformed, unproven or none of a client's business
};

/// A datagram that must leave now.
struct OutgoingDatagram {
  proto::PeerAddress to;
  ByteView bytes;      ///< borrowed until the session's next call
  bool media = false;  ///< RTP: what a mirror gets too
};

/// One client, without I/O: bytes, datagrams, frames and `now` in; bytes, datagrams and the next deadline
/// out. Never trusts the peer. Every queue is bounded. Not thread-safe; `now` never decreases.
class Session {
 public:
  Session(const SessionSettings& settings, const SessionKeys& keys, std::function<proto::Nonce()> fresh_nonce,
          Time now);

  /// What came on the TCP connection.
  void on_stream_bytes(ByteView bytes, Time now);
  /// The connection ended or broke.
  void on_stream_end(const std::string& why, Time now);
  /// In kHelloReceived: what the client asked for.
  [[nodiscard]] const proto::ClientHello& hello() const { return hello_; }
  /// Answers the hello: with a ServerHello, or a refusal when client and stream do not fit. Meta updates will
  /// be in the stream's `meta_codec` if the client knows it, else in the best form that says where blocks
  /// lie.
  void accept(proto::StreamDescription stream, Time now);
  void refuse(const proto::Refusal& refusal, Time now);
  /// After accept(): the form that was agreed on.
  [[nodiscard]] codec::MetaCodecKind meta_codec() const { return meta_codec_; }
  /// Says goodbye and closes, once that has left or the drain timeout passed.
  void close(proto::Goodbye::Reason reason, const std::string& text, Time now);

  /// A datagram that names this session or came from its address.
  void on_datagram(const proto::PeerAddress& from, ByteView datagram, Time now);
  /// A frame of its stream. Its meta always goes; a picture that does not fit is dropped and asks for
  /// refresh.
  void deliver(const FramePtr& frame, Time now);
  /// Timeouts. Call when next_deadline() is reached.
  void poll(Time now);

  /// What the TCP connection should take next; `stream_sent` says how much of it went.
  [[nodiscard]] ByteView stream_output() const { return reliable_.front(); }
  void stream_sent(std::size_t octets, Time now);
  /// The next datagram that may leave; call until nullopt.
  std::optional<OutgoingDatagram> next_datagram(Time now);
  [[nodiscard]] std::optional<Time> next_deadline() const;

  [[nodiscard]] SessionId id() const { return keys_.id; }
  [[nodiscard]] SessionState state() const { return state_; }
  /// Why it ends: "client left", "timeout: ...".
  [[nodiscard]] const std::string& end_reason() const { return end_reason_; }
  /// The stream should pause: a queue is over its bound.
  [[nodiscard]] bool is_congested() const { return reliable_.is_over() || media_.is_congested(); }
  /// True once after the client lost a picture.
  bool take_refresh_request() { return std::exchange(refresh_, false); }
  /// Why the client asks to be told all anew; once a request, and at most once a second: later then.
  std::optional<std::string> take_restart_request(Time now);
  /// The client's newest wish for its stream's atlas, if one came since the last call.
  std::optional<Emphasis> take_emphasis() { return std::exchange(emphasis_, std::nullopt); }
  [[nodiscard]] const std::optional<proto::ReceivedPose>& newest_pose() const { return poses_.newest(); }
  /// By RTCP; 0 before the first report.
  [[nodiscard]] Duration round_trip() const { return round_trip_; }
  /// Packets lost of those expected, by the last report, 0..1.
  [[nodiscard]] double loss() const { return loss_; }
  [[nodiscard]] const std::optional<proto::PeerAddress>& media_address() const {
    return gate_.media_address();
  }
  [[nodiscard]] const SessionCounts& counts() const { return counts_; }
  [[nodiscard]] std::uint32_t ssrc() const { return media_.ssrc(); }
  std::vector<Departure> take_departures() { return media_.take_departures(); }

 private:
  struct Control {
    proto::PeerAddress to;
    ByteBuffer bytes;
  };

  [[nodiscard]] bool is_open() const;
  void on_message(const proto::Message& message, Time now);
  void on_hello(const proto::ClientHello& hello);
  void on_restart_request(const proto::RestartRequest& request);
  void on_bad_bytes(const Error& error, Time now);
  bool on_probe(const proto::PeerAddress& from, ByteView datagram, Time now);
  bool on_confirm(const proto::PeerAddress& from, ByteView datagram, Time now);
  bool on_pose(ByteView datagram, Time now);
  bool on_sync(const proto::PeerAddress& from, ByteView datagram, Time now);
  bool on_rtcp(ByteView datagram, Time now);
  void on_reports(const std::vector<proto::ReportBlock>& blocks, Time now);
  void challenge(const proto::PeerAddress& from, std::size_t octets,
                 const std::optional<proto::UdpToken>& token, Time now);
  Control& add_control(const proto::PeerAddress& to);
  void finish(const std::string& reason, Time now);
  [[nodiscard]] std::optional<Time> timeout() const;

  SessionSettings settings_;
  codec::MetaCodecKind meta_codec_ = codec::MetaCodecKind::kPlain;
  SessionKeys keys_;
  std::function<proto::Nonce()> fresh_nonce_;
  SessionState state_ = SessionState::kWaitingHello;
  std::string end_reason_;
  Time since_;  ///< of connecting
  Time heard_;  ///< last valid datagram of the proven address
  Time closing_since_{};
  proto::FrameReader reader_;
  proto::ClientHello hello_;
  ReliableOutbox reliable_;
  MediaOutbox media_;
  proto::AddressGate gate_;
  proto::PoseInbox poses_;
  std::deque<Control> control_;  ///< challenges and sync answers
  ByteBuffer leaving_;           ///< what the last OutgoingDatagram borrowed
  bool refresh_ = false;
  std::optional<std::string> restart_;
  std::optional<Time> last_restart_;
  std::optional<Emphasis> emphasis_;
  Duration round_trip_{};
  double loss_ = 0;
  SessionCounts counts_;
};

const char* name(SessionState state);

}  // namespace atlaswire::server
