#pragma once

#include "base/bytes.h"
#include "base/ids.h"
#include "base/time.h"
#include "proto/datagram_batch.h"
#include "proto/h264_payload.h"
#include "proto/rtp.h"

#include <cstddef>
#include <cstdint>

namespace atlaswire::proto {

/// A picture that is to go out to one client.
struct PictureToSend {
  ByteView access_unit;  ///< Annex B
  FrameId frame{};
  PoseId pose{};   ///< of the receiving client
  Time capture{};  ///< server clock: when the pose was taken up
  bool idr = false;
};

/// Server, one a session: pictures to ready RTP datagrams, and the counts that sender reports need.
class RtpSender {
 public:
  struct Settings {
    std::uint32_t ssrc = 1;
    std::uint8_t payload_type = 96;
    std::size_t max_datagram = 1200;   ///< octets of UDP payload, everything included; at least 100
    std::uint16_t first_sequence = 0;  ///< random per RFC 3550 section 5.1
    std::uint32_t timestamp_base = 0;  ///< random, likewise
  };

  explicit RtpSender(const Settings& settings);

  /// Replaces `out`'s contents by the picture's datagrams, marker on the last. An access unit without a NAL
  /// unit gives an empty batch and uses no sequence number. Allocates nothing once `out` has grown.
  void packetize(const PictureToSend& picture, DatagramBatch& out);

  [[nodiscard]] std::uint32_t ssrc() const { return settings_.ssrc; }
  /// RTP time that belongs to `t`, for sender reports.
  [[nodiscard]] std::uint32_t rtp_time(Time t) const { return to_rtp_time(t, settings_.timestamp_base); }
  /// Counts for sender reports: of packets made, and of their payload octets; both wrap.
  [[nodiscard]] std::uint32_t packet_count() const { return packets_; }
  [[nodiscard]] std::uint32_t octet_count() const { return octets_; }

 private:
  Settings settings_;
  H264Packetizer packetizer_;
  std::uint16_t sequence_;
  std::uint16_t transport_sequence_ = 0;
  std::uint32_t packets_ = 0;
  std::uint32_t octets_ = 0;
};

}  // namespace atlaswire::proto
