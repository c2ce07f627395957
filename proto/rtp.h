#pragma once

#include "base/bytes.h"
#include "base/ids.h"
#include "base/result.h"
#include "proto/ntp_time.h"
#include "proto/wire_error.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace atlaswire::proto {

/// Numbers of our RFC 8285 one-byte header extensions; the SDP maps them (docs/PROTOCOL.md, section 4.1).
enum class RtpExtensionId : std::uint8_t { kFrame = 1, kPose = 2, kCaptureTime = 3, kTransportSequence = 4 };

/// Frame and transport sequence are on every packet of ours, pose and capture time on a frame's first.
struct RtpExtensions {
  std::optional<FrameId> frame;
  std::optional<PoseId> pose;
  std::optional<NtpTime> capture;  ///< server clock when the frame's pose was taken up for rendering
  std::optional<std::uint16_t> transport_sequence;
};

/// RFC 3550 section 5.1, without CSRC list: ours has none, a peer's is skipped.
struct RtpHeader {
  bool marker = false;             ///< last packet of a picture
  std::uint8_t payload_type = 96;  ///< 0..127
  std::uint16_t sequence = 0;
  std::uint32_t timestamp = 0;  ///< 90 kHz
  std::uint32_t ssrc = 0;
  RtpExtensions extensions;
};

/// A parsed packet; the payload (padding removed) borrows from the datagram.
struct RtpPacketView {
  RtpHeader header;
  ByteView payload;
};

/// Octets that `append_rtp_header` will write.
std::size_t rtp_header_size(const RtpExtensions& extensions);
/// Appends the header; the payload follows.
void append_rtp_header(const RtpHeader& header, ByteBuffer& out);

/// Safe on hostile bytes. Unknown extensions and other extension profiles are skipped; a known extension of a
/// wrong size, bad padding or a truncated part is refused.
Result<RtpPacketView> parse_rtp(ByteView datagram);

/// Follows a wrapping 16-bit sequence number: the value nearest to the last one that has these low bits.
class SequenceUnwrapper {
 public:
  std::int64_t unwrap(std::uint16_t sequence);
  /// As `unwrap`, without moving on.
  [[nodiscard]] std::int64_t peek(std::uint16_t sequence) const;

 private:
  std::optional<std::int64_t> last_;
};

}  // namespace atlaswire::proto
