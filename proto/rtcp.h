#pragma once

#include "base/bytes.h"
#include "base/result.h"
#include "proto/ntp_time.h"
#include "proto/wire_error.h"

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace atlaswire::proto {

/// RFC 3550 section 6.4.1: what a receiver says of one source.
struct ReportBlock {
  std::uint32_t ssrc = 0;
  std::uint8_t fraction_lost = 0;      ///< of 256, since the last report
  std::int32_t cumulative_lost = 0;    ///< 24 bits signed
  std::uint32_t highest_sequence = 0;  ///< extended
  std::uint32_t jitter = 0;            ///< 90 kHz units
  std::uint32_t last_report = 0;       ///< LSR, middle 32 bits of the last SR's time; 0: none
  std::uint32_t delay_since_last = 0;  ///< DLSR, 2^-16 s
  bool operator==(const ReportBlock&) const = default;
};

/// SR.
struct SenderReport {
  std::uint32_t ssrc = 0;
  NtpTime time = 0;
  std::uint32_t rtp_time = 0;
  std::uint32_t packets = 0;
  std::uint32_t octets = 0;
  std::vector<ReportBlock> blocks;  ///< at most 31
  bool operator==(const SenderReport&) const = default;
};

/// RR.
struct ReceiverReport {
  std::uint32_t ssrc = 0;
  std::vector<ReportBlock> blocks;  ///< at most 31
  bool operator==(const ReceiverReport&) const = default;
};

/// SDES with the one item that is mandatory, for one source.
struct SourceDescription {
  std::uint32_t ssrc = 0;
  std::string cname;  ///< at most 255 octets
  bool operator==(const SourceDescription&) const = default;
};

/// RFC 4585 section 6.3.1: "send me an IDR".
struct PictureLoss {
  std::uint32_t sender = 0;
  std::uint32_t media = 0;
  bool operator==(const PictureLoss&) const = default;
};

/// BYE of one source.
struct Bye {
  std::uint32_t ssrc = 0;
  std::string reason;  ///< at most 255 octets, may be empty
  bool operator==(const Bye&) const = default;
};

using RtcpPacket = std::variant<SenderReport, ReceiverReport, SourceDescription, PictureLoss, Bye>;

/// Replaces `out`'s contents by a compound packet; the first must be a SR or RR (RFC 3550 section 6.1).
void encode_rtcp(std::span<const RtcpPacket> packets, ByteBuffer& out);

/// Parses a compound packet. Packet types and SDES items we do not know are skipped; broken lengths, wrong
/// versions, padding other than at the end, or a first packet that is no report are refused. Safe on
/// hostile bytes; at most 64 packets.
Result<std::vector<RtcpPacket>> parse_rtcp(ByteView datagram);

}  // namespace atlaswire::proto
