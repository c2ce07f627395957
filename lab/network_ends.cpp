#include "lab/network_ends.h"

#include "base/program.h"
#include "base/random.h"
#include "client/pair_maker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

namespace atlaswire::lab {
namespace {

/// Frames before the path's start: enough for one to be on display there on the slowest profile that ships,
/// and for rate control to have seen some.
constexpr Duration kSettling = std::chrono::seconds(1);

constexpr proto::PeerAddress kClientAddress = proto::ipv4_address({10, 0, 0, 2}, 40'000);

/// What a daemon draws from a cryptographic generator comes from the point's seed here: runs repeat.
server::SessionKeys keys_of(Random& random) {
  server::SessionKeys keys;
  keys.id = SessionId{1};
  for (auto& octet : keys.token) octet = static_cast<std::byte>(random.bits());
  keys.ssrc = 2;
  keys.first_sequence = static_cast<std::uint16_t>(random.bits());
  keys.timestamp_base = static_cast<std::uint32_t>(random.bits());
  return keys;
}

server::Session make_session(const PointSettings& settings, Time now) {
  Random random(settings.seed);
  server::SessionSettings s;
  s.bit_rate = {settings.qp >= 0 ? 0 : static_cast<std::uint64_t>(std::llround(settings.bitrate_mbps * 1e6))};
  const server::SessionKeys keys = keys_of(random);
  const auto fresh_nonce = [random]() mutable {
    proto::Nonce nonce{};
    for (auto& octet : nonce) octet = static_cast<std::byte>(random.bits());
    return nonce;
  };
  return {s, keys, fresh_nonce, now};
}

client::SessionSettings client_settings(const PointSettings& settings) {
  client::SessionSettings s;
  s.hello.client_name = "atlas-lab";
  s.hello.display = settings.display;
  s.hello.vertical_fov = display_camera(settings).vertical_fov;
  s.hello.max_picture = {16'384, 16'384};
  s.hello.meta_codecs = client::readable_meta_codecs();
  s.hello.shows_motion = true;
  return s;
}

std::optional<Time> earlier(std::optional<Time> a, std::optional<Time> b) {
  if (!a || !b) return a ? a : b;
  return std::min(*a, *b);
}

netsim::Outgoing outgoing(netsim::FlowId flow, ByteView octets) {
  return {.flow = flow, .stream = flow == kReliable, .octets = {octets.begin(), octets.end()}};
}

}  // namespace

ServerEnd::ServerEnd(const PointSettings& settings, FrameSource& source, const Contender& contender, Time now,
                     Time zero)
    : settings_(settings),
      source_(&source),
      contender_(&contender),
      now_(now),
      zero_(zero),
      session_(make_session(settings, now)),
      cover_({}, from_seconds(1 / settings.server_hz)),
      interval_(from_seconds(1 / settings.server_hz)),
      making_(from_seconds(settings.server_ms * 1e-3)) {}

void ServerEnd::receive(netsim::FlowId flow, ByteView octets, Time now) {
  if (flow == kReliable) {
    session_.on_stream_bytes(octets, now);
  } else {
    session_.on_datagram(kClientAddress, octets, now);
  }
  react(now);
}

std::optional<Time> ServerEnd::next_deadline() const {
  std::optional<Time> due = earlier(session_.next_deadline(), next_frame_);
  if (!ready_.empty()) due = earlier(due, ready_.front().at);
  return due ? std::optional(std::max(*due, now_ + Duration{1})) : due;
}

void ServerEnd::wake(Time now) { react(now); }

void ServerEnd::react(Time now) {
  now_ = now;
  session_.poll(now);
  if (session_.state() == server::SessionState::kHelloReceived) {
    session_.accept(contender_->description(), now);
  }
  if (session_.state() >= server::SessionState::kClosing) {
    throw ProgramError(ExitCode::kInternal, "the modelled session ended: " + session_.end_reason());
  }
  if (session_.state() != server::SessionState::kStreaming) return;
  while (!ready_.empty() && ready_.front().at <= now) {
    session_.deliver(ready_.front().frame, now);
    ready_.pop_front();
  }
  for (const server::Departure& departure : session_.take_departures()) {
    if (!departure.dropped) cover_.on_sending(departure.left - departure.frame->stamps.encode_end);
  }
  const auto& pose = session_.newest_pose();
  if (!pose) return;
  if (!next_frame_) next_frame_ = std::max(now, zero_ - kSettling);
  if (now < *next_frame_) return;
  next_frame_ = *next_frame_ + interval_;
  if (!session_.is_congested()) make_frame(*pose, now);
}

void ServerEnd::make_frame(const proto::ReceivedPose& pose, Time now) {
  cover_.on_round_trip(session_.round_trip());
  const Duration posed = pose.received - zero_;
  const Duration until = now - zero_ + cover_.cover();
  auto frame = std::make_shared<server::EncodedFrame>(source_->make(
      pose.stamped.id, pose.stamped.pose,
      {.posed = posed, .made = now - zero_, .shown_from = until - interval_, .shown_until = until},
      session_.take_refresh_request()));
  const Time ready = now + making_;
  frame->stamps = {.pose_received = pose.received,
                   .render_start = now,
                   .render_end = ready,
                   .encode_end = ready,
                   .sent = ready};
  cover_.on_frame(ready - pose.received, last_frame_ ? now - *last_frame_ : interval_);
  last_frame_ = now;
  if (!first_frame_) first_frame_ = now;
  ready_.push_back({ready, std::move(frame)});
}

std::vector<netsim::Outgoing> ServerEnd::take_outgoing() {
  std::vector<netsim::Outgoing> out;
  while (!session_.stream_output().empty()) {
    const ByteView octets = session_.stream_output();
    out.push_back(outgoing(kReliable, octets));
    session_.stream_sent(octets.size(), now_);
  }
  while (const auto datagram = session_.next_datagram(now_))
    out.push_back(outgoing(kDatagrams, datagram->bytes));
  return out;
}

ClientEnd::ClientEnd(const PointSettings& settings, Contender& contender, const HeadMotion& motion, Time now,
                     Time zero)
    : contender_(&contender),
      motion_(&motion),
      zero_(zero),
      session_(client_settings(settings), now),
      pose_interval_(from_seconds(1 / settings.client_hz)),
      decoding_(from_seconds(settings.client_ms * 1e-3)),
      next_pose_(now) {}

void ClientEnd::receive(netsim::FlowId flow, ByteView octets, Time now) {
  if (flow == kReliable) {
    session_.on_stream_bytes(octets, now);
  } else {
    session_.on_datagram(octets, now);
  }
  react(now);
}

std::optional<Time> ClientEnd::next_deadline() const {
  std::optional<Time> due = earlier(session_.next_deadline(), next_pose_);
  if (!waiting_.empty()) due = earlier(due, waiting_.front().due);
  return due;
}

void ClientEnd::wake(Time now) { react(now); }

void ClientEnd::react(Time now) {
  if (const auto due = session_.next_deadline(); due && *due <= now) session_.poll(now);
  if (session_.end())
    throw ProgramError(ExitCode::kInternal, "the modelled session ended: " + session_.end()->text);
  sample_pose(now);
  collect(now);
  decode(now);
}

void ClientEnd::sample_pose(Time now) {
  if (now < next_pose_) return;
  next_pose_ += pose_interval_;
  const Pose pose = motion_->at(now - zero_);
  if (const auto id = session_.on_pose(pose, now)) poses_.add({.id = *id, .sampled = now, .pose = pose});
}

void ClientEnd::collect(Time now) {
  while (auto update = session_.pop_update()) {
    const auto pose = poses_.find(update->meta.pose);
    posed_.emplace(update->meta.frame, pose ? pose->sampled : now);
    waiting_.push_back(
        {now + decoding_, std::nullopt, client::UpdateArrival{.update = std::move(*update), .server = {}}});
  }
  while (auto frame = session_.pop_frame())
    waiting_.push_back({now + decoding_, std::move(*frame), std::nullopt});
}

void ClientEnd::decode(Time now) {
  for (; !waiting_.empty() && waiting_.front().due <= now; waiting_.pop_front()) {
    const Waiting& next = waiting_.front();
    if (next.update) {
      contender_->on_update(*next.update);
      note_half(next.update->update.meta.frame, now);
    }
    if (next.frame) {
      contender_->on_frame(*next.frame);
      note_half(next.frame->frame, now);
    }
    if (contender_->take_refresh()) session_.on_decode_failed();
  }
}

void ClientEnd::note_half(FrameId frame, Time now) {
  if (first_whole_ || halves_.insert(frame).second) return;
  first_whole_ = now;
  halves_.clear();
}

std::vector<netsim::Outgoing> ClientEnd::take_outgoing() {
  std::vector<netsim::Outgoing> out;
  if (const ByteBuffer octets = session_.take_stream_bytes(); !octets.empty()) {
    out.push_back(outgoing(kReliable, octets));
  }
  while (auto datagram = session_.pop_datagram()) out.push_back(outgoing(kDatagrams, *datagram));
  return out;
}

}  // namespace atlaswire::lab
