#pragma once

#include "base/bytes.h"
#include "server/asio_types.h"
#include "server/settings.h"

#include <string>

namespace atlaswire::server {

/// Sends copies of one session's RTP to a receiver that the operator names. Best effort: what does not fit
/// the socket is lost, and sessions never wait for it.
class Mirror {
 public:
  /// Resolves the host; throws ProgramError (kUsage) when there is none of that name.
  Mirror(asio::io_context& io, const HostPort& settings);
  void send(ByteView datagram);
  /// The receiver's IP address, for the SDP.
  [[nodiscard]] std::string address() const { return to_.address().to_string(); }

 private:
  udp::endpoint to_;
  udp::socket socket_;
};

/// The SDP of the mirrored stream for `mirror`; RFC 8866 text.
std::string mirror_sdp(const HostPort& mirror, const std::string& scene, const ByteBuffer& parameter_sets);

}  // namespace atlaswire::server
