#include "proto/rtp_sender.h"

#include "base/assert.h"

namespace atlaswire::proto {

RtpSender::RtpSender(const Settings& settings) : settings_(settings), sequence_(settings.first_sequence) {
  AW_ASSERT(settings.max_datagram >= 100 && settings.payload_type < 128);
}

void RtpSender::packetize(const PictureToSend& picture, DatagramBatch& out) {
  out.clear();
  out.frame = picture.frame;
  out.idr = picture.idr;
  RtpHeader header;
  header.payload_type = settings_.payload_type;
  header.timestamp = rtp_time(picture.capture);
  header.ssrc = settings_.ssrc;
  header.extensions = {picture.frame, std::nullopt, std::nullopt, transport_sequence_};
  RtpExtensions first = header.extensions;
  first.pose = picture.pose;
  first.capture = to_ntp(picture.capture);
  const auto plans = packetizer_.plan(picture.access_unit, settings_.max_datagram - rtp_header_size(first),
                                      settings_.max_datagram - rtp_header_size(header.extensions));
  for (std::size_t i = 0; i < plans.size(); ++i) {
    header.marker = i + 1 == plans.size();
    header.sequence = sequence_++;
    RtpHeader sent = header;
    if (i == 0) sent.extensions = first;
    sent.extensions.transport_sequence = transport_sequence_++;
    append_rtp_header(sent, out.octets);
    packetizer_.append(plans[i], out.octets);
    out.ends.push_back(static_cast<std::uint32_t>(out.octets.size()));
    ++packets_;
    octets_ += plans[i].size;
  }
}

}  // namespace atlaswire::proto
