#include "server/media_outbox.h"

#include "proto/ntp_time.h"
#include "proto/rtcp.h"

#include <algorithm>
#include <array>
#include <string>

namespace atlaswire::server {

MediaOutbox::MediaOutbox(const Settings& settings)
    : settings_(settings), sender_(settings.rtp), pacer_(settings.pacer) {}

bool MediaOutbox::send(const FramePtr& frame, Time now) {
  note_departures(now);
  sender_.packetize({frame->video, frame->frame, frame->pose, frame->stamps.render_start, frame->idr},
                    batch_);
  const proto::PacerVerdict verdict = pacer_.enqueue(batch_, now);
  for (std::uint32_t i = 0; i < verdict.dropped && !waiting_.empty(); ++i) {
    departures_.push_back({waiting_.back().frame, waiting_.back().queued, now, true});
    waiting_.pop_back();
  }
  if (!verdict.accepted) {
    departures_.push_back({frame, now, now, true});
    return false;
  }
  waiting_.push_back({frame, now});
  if (!report_due_) report_due_ = now;
  return !verdict.needs_idr();
}

bool MediaOutbox::is_congested() const {
  if (pacer_.queued_pictures() >= settings_.max_pictures) return true;
  const auto& pacer = settings_.pacer;
  return pacer_.queued().count > 0 && pacer.rate.time_for(pacer_.queued()) > pacer.max_delay / 2;
}

std::optional<ByteView> MediaOutbox::next_media(Time now) {
  const auto datagram = pacer_.pop(now);
  note_departures(now);
  return datagram;
}

void MediaOutbox::note_departures(Time now) {
  while (waiting_.size() > pacer_.queued_pictures()) {
    departures_.push_back({waiting_.front().frame, waiting_.front().queued, now, false});
    waiting_.pop_front();
  }
}

std::optional<ByteView> MediaOutbox::next_report(Time now) {
  if (!report_due_ || now < *report_due_) return std::nullopt;
  report_due_ = now + settings_.report_interval;
  const std::array<proto::RtcpPacket, 2> packets{proto::SenderReport{sender_.ssrc(),
                                                                     proto::to_ntp(now),
                                                                     sender_.rtp_time(now),
                                                                     sender_.packet_count(),
                                                                     sender_.octet_count(),
                                                                     {}},
                                                 proto::SourceDescription{sender_.ssrc(), "atlaswire"}};
  proto::encode_rtcp(packets, report_);
  return ByteView(report_);
}

std::optional<Time> MediaOutbox::next_deadline() const {
  const auto media = pacer_.next_deadline();
  if (!media || !report_due_) return media ? media : report_due_;
  return std::min(*media, *report_due_);
}

}  // namespace atlaswire::server
