#pragma once

#include "base/bytes.h"

#include <cstdint>
#include <string>

namespace atlaswire::proto {

/// What a session description says of the video stream (docs/PROTOCOL.md, section 6).
struct SdpSettings {
  std::string session_name = "atlaswire";
  std::string address = "127.0.0.1";  ///< where the receiver listens; IPv6 when it holds a colon
  std::uint16_t port = 0;             ///< where the receiver listens
  std::uint8_t payload_type = 96;
  std::uint32_t ssrc = 0;  ///< 0: not named
  std::string cname = "atlaswire";
  ByteBuffer parameter_sets;  ///< Annex B SPS and PPS; empty: not known yet, in band only
  bool sending = false;       ///< a=sendonly for an offer by the sender; else a=recvonly
};

/// RFC 8866 text, CRLF line ends, that ffplay and GStreamer open.
std::string make_sdp(const SdpSettings& settings);

}  // namespace atlaswire::proto
