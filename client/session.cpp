#include "client/session.h"

#include "proto/datagram.h"
#include "proto/handshake.h"
#include "proto/rtcp.h"
#include "proto/rtp.h"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

namespace atlaswire::client {
namespace {

/// A peer cannot make us hold more than this, whatever it sends: the shell drains after every call.
constexpr std::size_t kMaxDatagramsOut = 256;

std::string in_seconds(Duration d) {
  std::string text = std::to_string(to_seconds(d));
  text.resize(text.find('.') + 2);
  return text + " s";
}

}  // namespace

ExitCode exit_code(SessionEnd::Kind kind) {
  switch (kind) {
    case SessionEnd::Kind::kFinished:
    case SessionEnd::Kind::kServerDone:
      return ExitCode::kOk;
    case SessionEnd::Kind::kNoAnswer:
      return ExitCode::kCannotConnect;
    case SessionEnd::Kind::kRefused:
      return ExitCode::kRefused;
    case SessionEnd::Kind::kServerGone:
    case SessionEnd::Kind::kProtocolError:
      return ExitCode::kPeerLost;
  }
  return ExitCode::kInternal;
}

Session::Media::Media(const proto::ServerHello& answer, const SessionSettings& settings)
    : greeter(answer.session, answer.udp_token),
      clock(answer.session),
      poses(answer.session),
      assembler(settings.assembler) {}

Session::Session(const SessionSettings& settings, Time now)
    : settings_(settings), reader_(proto::kMaxEnvelopeBeforeHello), started_(now), last_heard_(now) {
  send_message(settings_.hello);
}

void Session::on_stream_bytes(ByteView bytes, Time now) {
  if (end_) return;
  last_heard_ = now;
  reader_.feed(bytes);
  while (!end_) {
    Result<std::optional<ByteView>> frame = reader_.next();
    if (!frame) return break_off("the server sent a message of illegal length: " + frame.error().message());
    if (!*frame) return;
    const std::size_t octets = (*frame)->size() + 4;
    Result<proto::Message> message = proto::parse_message(**frame);
    if (!message) return break_off("the server sent a malformed message: " + message.error().message());
    on_message(std::move(*message), octets, now);
  }
}

void Session::on_message(proto::Message&& message, std::size_t octets, Time now) {
  if (auto* meta = std::get_if<proto::FrameMeta>(&message)) {
    if (!answer_) return break_off("the server sent a frame before it answered the hello");
    traffic_.meta += octets;
    updates_.push_back({.meta = std::move(*meta), .arrival = now, .octets = octets});
    return;
  }
  traffic_.control_in += octets;
  if (const auto* answer = std::get_if<proto::ServerHello>(&message)) {
    if (answer_) return break_off("the server answered the hello twice");
    return on_answer(*answer, now);
  }
  if (const auto* refusal = std::get_if<proto::Refusal>(&message)) {
    if (answer_) return break_off("the server refused a session that it had granted");
    return end_with(SessionEnd::Kind::kRefused, std::string("the server refused: ") + refusal->text + " (" +
                                                    proto::name(refusal->code) + ")");
  }
  if (const auto* goodbye = std::get_if<proto::Goodbye>(&message)) {
    using Reason = proto::Goodbye::Reason;
    const bool orderly = goodbye->reason == Reason::kDone || goodbye->reason == Reason::kDraining;
    const std::string why = goodbye->text.empty() ? "no reason given" : goodbye->text;
    return end_with(
        orderly ? SessionEnd::Kind::kServerDone : SessionEnd::Kind::kServerGone,
        std::string("the server ended the session: ") + why + " (" + proto::name(goodbye->reason) + ")");
  }
  break_off(std::string("the server sent a ") + proto::message_name(message) + ", which only clients send");
}

void Session::on_answer(const proto::ServerHello& answer, Time now) {
  if (Result<void> kept = proto::check_answer(settings_.hello, answer); !kept) {
    return break_off("the server's answer does not fit our hello: " + kept.error().message());
  }
  const proto::StreamDescription& stream = answer.stream;
  const std::uint32_t planes = stream.has_coverage ? 2 : 1;
  if (stream.picture.width != stream.atlas.width || stream.picture.height != stream.atlas.height * planes) {
    return break_off("the server's picture holds more than the atlas and its coverage, which we cannot show");
  }
  answer_ = answer;
  media_.emplace(answer, settings_);
  media_due_ = now + settings_.datagram_timeout;
  next_report_ = now + settings_.report_interval;
  reader_.set_limit(proto::kMaxEnvelope);
  if (settings_.emphasis && !emphasis_) set_emphasis(*settings_.emphasis, now + settings_.emphasis_after);
}

void Session::on_stream_closed(Time) {
  if (end_) return;
  if (!answer_) {
    return end_with(
        SessionEnd::Kind::kNoAnswer,
        "the server closed the connection without an answer: is it an atlasd, and of this version?");
  }
  end_with(SessionEnd::Kind::kServerGone, "the server closed the connection without a goodbye: see its log");
}

void Session::on_datagram(ByteView datagram, Time now) {
  if (end_) return;
  if (!media_) return refuse_datagram(datagram);
  switch (proto::classify(datagram)) {
    case proto::DatagramKind::kRtp:
      return on_rtp(datagram, now);
    case proto::DatagramKind::kRtcp:
      return on_rtcp(datagram, now);
    case proto::DatagramKind::kChallenge:
      return on_challenge(datagram, now);
    case proto::DatagramKind::kSyncResponse:
      return on_sync_response(datagram, now);
    default:
      return refuse_datagram(datagram);
  }
}

void Session::accept_datagram(Time now) {
  last_heard_ = now;
  media_due_.reset();
  media_->greeter.on_received(now);
}

void Session::refuse_datagram(ByteView datagram) {
  ++packets_.refused;
  traffic_.ignored += datagram.size();
}

void Session::on_rtp(ByteView datagram, Time now) {
  const Result<proto::RtpPacketView> packet = proto::parse_rtp(datagram);
  if (!packet || packet->header.ssrc != answer_->stream.ssrc ||
      packet->header.payload_type != answer_->stream.payload_type) {
    return refuse_datagram(datagram);
  }
  accept_datagram(now);
  traffic_.video += datagram.size();
  media_->reception.on_packet(packet->header, now);
  media_->assembler.add(*packet, datagram.size(), now);
  drain_assembler();
}

void Session::on_rtcp(ByteView datagram, Time now) {
  const Result<std::vector<proto::RtcpPacket>> packets = proto::parse_rtcp(datagram);
  if (!packets) return refuse_datagram(datagram);
  bool ours = false;
  for (const proto::RtcpPacket& packet : *packets) {
    const auto* report = std::get_if<proto::SenderReport>(&packet);
    if (report == nullptr || report->ssrc != answer_->stream.ssrc) continue;
    media_->reception.on_sender_report(*report, now);
    ours = true;
  }
  if (!ours) return refuse_datagram(datagram);
  accept_datagram(now);
  traffic_.control_in += datagram.size();
}

void Session::on_challenge(ByteView datagram, Time now) {
  const Result<proto::Challenge> challenge = proto::parse_challenge(datagram);
  if (!challenge) return refuse_datagram(datagram);
  const std::optional<proto::Confirm> confirm = media_->greeter.on_challenge(*challenge);
  if (!confirm) return refuse_datagram(datagram);
  last_heard_ = now;
  traffic_.control_in += datagram.size();
  ByteBuffer out;
  proto::encode(*confirm, out);
  send_datagram(std::move(out), traffic_.control_out);
}

void Session::on_sync_response(ByteView datagram, Time now) {
  const Result<proto::SyncResponse> response = proto::parse_sync_response(datagram);
  if (!response || response->session != answer_->session || !media_->clock.on_response(*response, now)) {
    return refuse_datagram(datagram);
  }
  accept_datagram(now);
  traffic_.control_in += datagram.size();
}

std::optional<PoseId> Session::on_pose(const Pose& pose, Time sampled) {
  if (end_ || !media_) return std::nullopt;
  const PoseId id = media_->poses.push(pose, sampled);
  ByteBuffer out;
  proto::encode(media_->poses.packet(), out);
  send_datagram(std::move(out), traffic_.poses);
  return id;
}

void Session::set_emphasis(Emphasis emphasis, Time at) {
  emphasis_ = std::move(emphasis);
  emphasis_due_ = at;
}

void Session::tell_emphasis(Time now) {
  if (!emphasis_ || now < emphasis_due_) return;
  send_message(*std::exchange(emphasis_, std::nullopt));
}

void Session::on_decode_failed() {
  if (media_) media_->assembler.require_idr();
}

void Session::poll(Time now) {
  if (end_) return;
  check_patience(now);
  if (end_ || !media_) return;
  ByteBuffer out;
  if (const auto probe = media_->greeter.poll(now)) {
    proto::encode(*probe, out);
    send_datagram(std::move(out), traffic_.control_out);
  }
  if (const auto request = media_->clock.poll(now)) {
    out.clear();
    proto::encode(*request, out);
    send_datagram(std::move(out), traffic_.control_out);
  }
  tell_emphasis(now);
  media_->assembler.poll(now);
  drain_assembler();
  const Duration trip = std::max(media_->clock.round_trip(), settings_.pli_round_trip_floor);
  if (media_->refresh.poll(media_->assembler.needs_refresh(), trip, now)) send_refresh_request();
  if (now >= next_report_) send_report(now);
}

void Session::check_patience(Time now) {
  if (!answer_) {
    if (now < started_ + settings_.answer_timeout) return;
    return end_with(SessionEnd::Kind::kNoAnswer,
                    "the server accepted the connection but did not answer within " +
                        in_seconds(settings_.answer_timeout) + ": is it an atlasd, or overloaded?");
  }
  if (media_due_ && now >= *media_due_) {
    return end_with(SessionEnd::Kind::kServerGone, "no datagram came from the server within " +
                                                       in_seconds(settings_.datagram_timeout) +
                                                       ": let UDP pass on the port that TCP uses");
  }
  if (now >= last_heard_ + settings_.silence_timeout) {
    end_with(SessionEnd::Kind::kServerGone, "nothing came from the server for " +
                                                in_seconds(settings_.silence_timeout) +
                                                ": it is gone or cut off");
  }
}

std::optional<Time> Session::next_deadline() const {
  if (end_) return std::nullopt;
  if (!answer_) return started_ + settings_.answer_timeout;
  Time next = std::min({last_heard_ + settings_.silence_timeout, next_report_,
                        media_->greeter.next_deadline(), media_->clock.next_deadline()});
  if (media_due_) next = std::min(next, *media_due_);
  if (emphasis_) next = std::min(next, emphasis_due_);
  if (const auto gap = media_->assembler.next_deadline()) next = std::min(next, *gap);
  if (media_->assembler.needs_refresh())
    next = std::min(next, media_->refresh.next_deadline().value_or(Time{}));
  return next;
}

void Session::send_report(Time now) {
  next_report_ = now + settings_.report_interval;
  std::array<proto::RtcpPacket, 2> packets{
      proto::ReceiverReport{.ssrc = settings_.ssrc, .blocks = {}},
      proto::SourceDescription{.ssrc = settings_.ssrc, .cname = settings_.cname}};
  if (const auto block = media_->reception.report(now)) {
    std::get<proto::ReceiverReport>(packets[0]).blocks.push_back(*block);
  }
  ByteBuffer out;
  proto::encode_rtcp(packets, out);
  send_datagram(std::move(out), traffic_.control_out);
  send_message(proto::StatsReport{.newest_frame = progress_.newest_frame,
                                  .frames_paired = progress_.paired,
                                  .frames_lost = media_->assembler.counts().lost,
                                  .frames_displayed = progress_.displayed,
                                  .display_rate = std::clamp(progress_.display_rate, 0.0, 10'000.0),
                                  .motion_to_photon = std::clamp(progress_.motion_to_photon, Duration{},
                                                                 Duration{std::chrono::seconds(60)})});
}

void Session::send_refresh_request() {
  ++packets_.refresh_requests;
  const std::array<proto::RtcpPacket, 2> packets{
      proto::ReceiverReport{.ssrc = settings_.ssrc, .blocks = {}},
      proto::PictureLoss{.sender = settings_.ssrc, .media = answer_->stream.ssrc}};
  ByteBuffer out;
  proto::encode_rtcp(packets, out);
  send_datagram(std::move(out), traffic_.control_out);
}

void Session::send_message(const proto::Message& message) {
  const std::size_t before = stream_out_.size();
  proto::append_message(message, stream_out_);
  traffic_.control_out += stream_out_.size() - before;
}

void Session::send_datagram(ByteBuffer datagram, std::uint64_t& channel) {
  if (datagrams_out_.size() >= kMaxDatagramsOut) return;
  channel += datagram.size();
  datagrams_out_.push_back(std::move(datagram));
}

void Session::drain_assembler() {
  while (std::optional<proto::AssembledFrame> frame = media_->assembler.pop()) {
    frames_.push_back(std::move(*frame));
  }
}

void Session::request_restart(FrameId frame, const std::string& why) {
  if (!end_ && answer_) send_message(proto::RestartRequest{.frame = frame, .text = why});
}

void Session::fail(const std::string& why) {
  if (!end_) break_off(why);
}

void Session::finish() {
  if (end_) return;
  if (answer_) send_message(proto::Goodbye{.reason = proto::Goodbye::Reason::kDone, .text = {}});
  end_with(SessionEnd::Kind::kFinished, {});
}

void Session::break_off(const std::string& why) {
  if (answer_) {
    send_message(
        proto::Goodbye{.reason = proto::Goodbye::Reason::kProtocolError, .text = why.substr(0, 1000)});
  }
  end_with(answer_ ? SessionEnd::Kind::kProtocolError : SessionEnd::Kind::kNoAnswer, why);
}

void Session::end_with(SessionEnd::Kind kind, std::string text) {
  end_ = SessionEnd{.kind = kind, .text = std::move(text)};
}

ByteBuffer Session::take_stream_bytes() { return std::exchange(stream_out_, {}); }

std::optional<ByteBuffer> Session::pop_datagram() {
  if (datagrams_out_.empty()) return std::nullopt;
  ByteBuffer datagram = std::move(datagrams_out_.front());
  datagrams_out_.pop_front();
  return datagram;
}

std::optional<proto::AssembledFrame> Session::pop_frame() {
  if (frames_.empty()) return std::nullopt;
  proto::AssembledFrame frame = std::move(frames_.front());
  frames_.pop_front();
  return frame;
}

std::optional<ArrivedUpdate> Session::pop_update() {
  if (updates_.empty()) return std::nullopt;
  ArrivedUpdate update = std::move(updates_.front());
  updates_.pop_front();
  return update;
}

PacketCounts Session::packets() const {
  PacketCounts counts = packets_;
  if (media_) {
    counts.received = media_->reception.received();
    counts.lost = media_->reception.lost();
  }
  return counts;
}

proto::AssemblerCounts Session::frames() const {
  return media_ ? media_->assembler.counts() : proto::AssemblerCounts{};
}

}  // namespace atlaswire::client
