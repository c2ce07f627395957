#include "proto/clock_sync.h"
#include "proto/datagram.h"
#include "proto/rtcp_stats.h"
#include "server/session.h"

#include <algorithm>
#include <utility>

namespace atlaswire::server {

namespace {

/// Challenges and sync answers that may wait; a client needs one or two at a time.
constexpr std::size_t kMaxControl = 64;

}  // namespace

void Session::on_datagram(const proto::PeerAddress& from, ByteView datagram, Time now) {
  if (state_ != SessionState::kWaitingAddress && state_ != SessionState::kStreaming) {
    ++counts_.ignored_datagrams;
    return;
  }
  const auto kind = proto::classify(datagram);
  bool used = false;
  if (kind == proto::DatagramKind::kProbe) {
    used = on_probe(from, datagram, now);
  } else if (kind == proto::DatagramKind::kConfirm) {
    used = on_confirm(from, datagram, now);
  } else if (gate_.is_proven(from)) {
    if (kind == proto::DatagramKind::kPose) used = on_pose(datagram, now);
    if (kind == proto::DatagramKind::kSyncRequest) used = on_sync(from, datagram, now);
    if (kind == proto::DatagramKind::kRtcp) used = on_rtcp(datagram, now);
    if (used) heard_ = now;
  } else if (kind == proto::DatagramKind::kPose || kind == proto::DatagramKind::kSyncRequest) {
    challenge(from, datagram.size(), std::nullopt, now);
  }
  if (!used) ++counts_.ignored_datagrams;
}

bool Session::on_probe(const proto::PeerAddress& from, ByteView datagram, Time now) {
  const auto probe = proto::parse_probe(datagram);
  if (!probe || probe->session != keys_.id) return false;
  challenge(from, datagram.size(), probe->token, now);
  return true;
}

bool Session::on_confirm(const proto::PeerAddress& from, ByteView datagram, Time now) {
  const auto confirm = proto::parse_confirm(datagram);
  if (!confirm || confirm->session != keys_.id) return false;
  if (!gate_.on_confirm(from, datagram.size(), confirm->token, confirm->nonce, now)) return false;
  heard_ = now;
  state_ = SessionState::kStreaming;
  return true;
}

bool Session::on_pose(ByteView datagram, Time now) {
  const auto packet = proto::parse_pose_packet(datagram);
  if (!packet || packet->session != keys_.id) return false;
  poses_.add(*packet, now);
  return true;
}

bool Session::on_sync(const proto::PeerAddress& from, ByteView datagram, Time now) {
  const auto request = proto::parse_sync_request(datagram);
  if (!request || request->session != keys_.id) return false;
  if (control_.size() < kMaxControl) encode(proto::answer_sync(*request, now, now), add_control(from).bytes);
  return true;
}

bool Session::on_rtcp(ByteView datagram, Time now) {
  const auto packets = proto::parse_rtcp(datagram);
  if (!packets) return false;
  for (const auto& packet : *packets) {
    if (const auto* report = std::get_if<proto::ReceiverReport>(&packet)) on_reports(report->blocks, now);
    if (const auto* report = std::get_if<proto::SenderReport>(&packet)) on_reports(report->blocks, now);
    const auto* loss = std::get_if<proto::PictureLoss>(&packet);
    if (loss == nullptr || loss->media != keys_.ssrc) continue;
    ++counts_.picture_losses;
    refresh_ = true;
  }
  return true;
}

void Session::on_reports(const std::vector<proto::ReportBlock>& blocks, Time now) {
  for (const auto& block : blocks) {
    if (block.ssrc != keys_.ssrc) continue;
    loss_ = block.fraction_lost / 256.0;
    if (const auto measured = proto::round_trip(block, now)) round_trip_ = *measured;
  }
}

void Session::challenge(const proto::PeerAddress& from, std::size_t octets,
                        const std::optional<proto::UdpToken>& token, Time now) {
  if (control_.size() >= kMaxControl) return;
  const auto nonce = gate_.on_datagram(from, octets, token, fresh_nonce_(), now);
  if (nonce) encode(proto::Challenge{keys_.id, *nonce}, add_control(from).bytes);
}

Session::Control& Session::add_control(const proto::PeerAddress& to) {
  control_.push_back({to, {}});
  return control_.back();
}

std::optional<OutgoingDatagram> Session::next_datagram(Time now) {
  if (!control_.empty()) {
    const proto::PeerAddress to = control_.front().to;
    leaving_ = std::move(control_.front().bytes);
    control_.pop_front();
    return OutgoingDatagram{to, leaving_, false};
  }
  if (state_ != SessionState::kStreaming || !gate_.media_address()) return std::nullopt;
  if (const auto report = media_.next_report(now))
    return OutgoingDatagram{*gate_.media_address(), *report, false};
  if (const auto media = media_.next_media(now))
    return OutgoingDatagram{*gate_.media_address(), *media, true};
  return std::nullopt;
}

}  // namespace atlaswire::server
