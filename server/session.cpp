#include "server/session.h"

#include "base/assert.h"
#include "proto/handshake.h"
#include "proto/plain_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace atlaswire::server {

namespace {

ReliableOutbox::Settings reliable_settings(const SessionSettings& s) {
  return {s.delivery.tcp_queue_bytes, s.admission.stall_timeout};
}

MediaOutbox::Settings media_settings(const SessionSettings& s, const SessionKeys& keys) {
  MediaOutbox::Settings media;
  media.rtp.ssrc = keys.ssrc;
  media.rtp.first_sequence = keys.first_sequence;
  media.rtp.timestamp_base = keys.timestamp_base;
  media.rtp.max_datagram = s.delivery.max_datagram;
  media.pacer.max_queued.count = s.delivery.media_queue_bytes;
  media.pacer.rate = proto::kUnlimitedRate;
  if (s.bit_rate.bits_per_second != 0) {
    const double rate = static_cast<double>(s.bit_rate.bits_per_second) * s.delivery.pacing;
    media.pacer.rate.bits_per_second = static_cast<std::uint64_t>(rate);
  }
  return media;
}

constexpr std::size_t kMaxText = 1024;
/// A restart costs an I-frame and everything told anew: however often a client asks, no more of them.
constexpr Duration kRestartSpacing = std::chrono::seconds(1);

std::optional<Time> earliest(std::optional<Time> a, std::optional<Time> b) {
  if (!a || !b) return a ? a : b;
  return std::min(*a, *b);
}

}  // namespace

const char* name(SessionState state) {
  switch (state) {
    case SessionState::kWaitingHello:
      return "waiting for hello";
    case SessionState::kHelloReceived:
      return "hello received";
    case SessionState::kWaitingAddress:
      return "waiting for address";
    case SessionState::kStreaming:
      return "streaming";
    case SessionState::kClosing:
      return "closing";
    case SessionState::kClosed:
      return "closed";
  }
  return "unknown";
}

Session::Session(const SessionSettings& settings, const SessionKeys& keys,
                 std::function<proto::Nonce()> fresh_nonce, Time now)
    : settings_(settings),
      keys_(keys),
      fresh_nonce_(std::move(fresh_nonce)),
      since_(now),
      heard_(now),
      reader_(proto::kMaxEnvelopeBeforeHello),
      reliable_(reliable_settings(settings)),
      media_(media_settings(settings, keys)),
      gate_(keys.token) {}

bool Session::is_open() const { return state_ != SessionState::kClosing && state_ != SessionState::kClosed; }

void Session::on_stream_bytes(ByteView bytes, Time now) {
  if (!is_open()) return;
  reader_.feed(bytes);
  while (is_open()) {
    auto envelope = reader_.next();
    if (!envelope) return on_bad_bytes(envelope.error(), now);
    if (!*envelope) return;
    auto message = proto::parse_message(**envelope);
    if (!message) return on_bad_bytes(message.error(), now);
    on_message(*message, now);
  }
}

void Session::on_message(const proto::Message& message, Time now) {
  if (state_ == SessionState::kWaitingHello) {
    if (const auto* hello = std::get_if<proto::ClientHello>(&message)) return on_hello(*hello);
  } else if (state_ == SessionState::kHelloReceived) {
    // The owner answers before it feeds more: whatever follows the hello came too early.
  } else if (const auto* bye = std::get_if<proto::Goodbye>(&message)) {
    return finish(fmt::format("client left ({}{}{})", proto::name(bye->reason), bye->text.empty() ? "" : ": ",
                              bye->text),
                  now);
  } else if (const auto* lost = std::get_if<proto::RestartRequest>(&message)) {
    return on_restart_request(*lost);
  } else if (std::holds_alternative<proto::StatsReport>(message)) {
    return;
  } else if (const auto* emphasis = std::get_if<Emphasis>(&message)) {
    emphasis_ = *emphasis;
    return;
  }
  on_bad_bytes(Error(proto::WireError::kBadType,
                     fmt::format("a {} while {}", proto::message_name(message), name(state_))),
               now);
}

void Session::on_restart_request(const proto::RestartRequest& request) {
  restart_ = fmt::format("frame {}: {}", value(request.frame), request.text);
  ++counts_.restarts;
}

std::optional<std::string> Session::take_restart_request(Time now) {
  if (!restart_ || (last_restart_ && now - *last_restart_ < kRestartSpacing)) return std::nullopt;
  last_restart_ = now;
  return std::exchange(restart_, std::nullopt);
}

void Session::on_hello(const proto::ClientHello& hello) {
  hello_ = hello;
  state_ = SessionState::kHelloReceived;
}

void Session::on_bad_bytes(const Error& error, Time now) {
  if (state_ == SessionState::kWaitingHello || state_ == SessionState::kHelloReceived) {
    return refuse(proto::refusal_for(error), now);
  }
  close(proto::Goodbye::Reason::kProtocolError, error.message(), now);
}

void Session::accept(proto::StreamDescription stream, Time now) {
  AW_ASSERT(state_ == SessionState::kHelloReceived);
  // The stream's own, then those that every stream can give, the best first.
  std::vector<std::uint32_t> meta_codecs{stream.meta_codec};
  for (const codec::MetaCodecKind kind : codec::kMetaCodecs) {
    if (!leaves_positions(kind)) meta_codecs.push_back(static_cast<std::uint32_t>(kind));
  }
  const auto terms = proto::agree(hello_, meta_codecs, stream.picture);
  if (!terms) return refuse(proto::refusal_for(terms.error()), now);
  stream.meta_codec = terms->meta_codec;
  meta_codec_ = static_cast<codec::MetaCodecKind>(terms->meta_codec);
  if (!leaves_positions(meta_codec_)) stream.memory.reset();
  if (!hello_.shows_motion) stream.motion.reset();
  stream.ssrc = keys_.ssrc;
  reader_.set_limit(proto::kMaxEnvelope);
  reliable_.push(proto::ServerHello{terms->version, keys_.id, keys_.token, std::move(stream)}, now);
  state_ = SessionState::kWaitingAddress;
}

void Session::refuse(const proto::Refusal& refusal, Time now) {
  if (!is_open()) return;
  reliable_.push(proto::Refusal{refusal.code, proto::to_plain_text(refusal.text, kMaxText)}, now);
  state_ = SessionState::kClosing;
  closing_since_ = now;
  end_reason_ = fmt::format("refused ({}): {}", proto::name(refusal.code), refusal.text);
}

void Session::close(proto::Goodbye::Reason reason, const std::string& text, Time now) {
  if (!is_open()) return;
  if (state_ == SessionState::kWaitingHello || state_ == SessionState::kHelloReceived) {
    const bool draining = reason == proto::Goodbye::Reason::kDraining;
    return refuse({draining ? proto::Refusal::Code::kDraining : proto::Refusal::Code::kBadHello, text}, now);
  }
  reliable_.push(proto::Goodbye{reason, proto::to_plain_text(text, kMaxText)}, now);
  state_ = SessionState::kClosing;
  closing_since_ = now;
  end_reason_ = fmt::format("{}: {}", proto::name(reason), text);
}

void Session::on_stream_end(const std::string& why, Time now) { finish(why, now); }

void Session::finish(const std::string& reason, Time /*now*/) {
  if (end_reason_.empty()) end_reason_ = reason;
  state_ = SessionState::kClosed;
}

void Session::deliver(const FramePtr& frame, Time now) {
  if (state_ != SessionState::kStreaming) return;
  proto::FrameMeta meta{.frame = frame->frame,
                        .pose = frame->pose,
                        .stamps = frame->stamps,
                        .cover = frame->cover,
                        .meta = frame->meta,
                        .scene_time = frame->scene_time,
                        .scene_ahead = frame->scene_ahead,
                        .motion = frame->motion};
  meta.stamps.sent = now;
  reliable_.push(meta, now);
  if (!media_.send(frame, now)) {
    ++counts_.frames_dropped;
    refresh_ = true;
  }
  ++counts_.frames;
  counts_.video_bytes += frame->video.size();
  counts_.meta_bytes += frame->meta.size() + frame->motion.size();
}

void Session::poll(Time now) {
  using Reason = proto::Goodbye::Reason;
  if (state_ == SessionState::kClosing) {
    const bool said = reliable_.size() == 0;
    if (said || now - closing_since_ >= settings_.admission.drain_timeout) finish(end_reason_, now);
    return;
  }
  if (!is_open()) return;
  if (reliable_.is_stalled(now)) {
    // Its queue is full: a goodbye would not get through either.
    return finish(fmt::format("too slow: {} octets wait on TCP", reliable_.size()), now);
  }
  const auto due = timeout();
  if (!due || now < *due) return;
  if (state_ == SessionState::kStreaming) return close(Reason::kTimeout, "no pose and no report came", now);
  const bool greeted = state_ == SessionState::kWaitingAddress;
  close(Reason::kTimeout, greeted ? "no UDP datagram proved your address; is UDP blocked?" : "no hello came",
        now);
}

std::optional<Time> Session::timeout() const {
  const auto& admission = settings_.admission;
  switch (state_) {
    case SessionState::kWaitingHello:
    case SessionState::kHelloReceived:
    case SessionState::kWaitingAddress:
      return since_ + admission.hello_timeout;
    case SessionState::kStreaming:
      return heard_ + admission.idle_timeout;
    case SessionState::kClosing:
      return closing_since_ + admission.drain_timeout;
    case SessionState::kClosed:
      break;
  }
  return std::nullopt;
}

std::optional<Time> Session::next_deadline() const {
  auto due = timeout();
  if (is_open()) due = earliest(due, reliable_.next_deadline());
  if (state_ == SessionState::kStreaming) due = earliest(due, media_.next_deadline());
  return due;
}

void Session::stream_sent(std::size_t octets, Time now) {
  reliable_.consume(octets, now);
  if (state_ == SessionState::kClosing && reliable_.size() == 0) finish(end_reason_, now);
}

}  // namespace atlaswire::server
