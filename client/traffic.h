#pragma once

#include <cstdint>

namespace atlaswire::client {

/// Octets that crossed the network, by channel: UDP payloads and TCP contents, headers of lower layers not
/// counted.
struct Traffic {
  std::uint64_t video = 0;        ///< RTP datagrams of the stream, duplicates and late ones included
  std::uint64_t meta = 0;         ///< FrameMeta messages, length prefix included
  std::uint64_t control_in = 0;   ///< everything else from the server: hello, RTCP, clock sync, challenges
  std::uint64_t poses = 0;        ///< to the server
  std::uint64_t control_out = 0;  ///< everything else to the server
  std::uint64_t ignored = 0;      ///< datagrams that were nothing of this session
};

/// Packets of the media stream.
struct PacketCounts {
  std::uint64_t received = 0;
  std::uint64_t refused = 0;           ///< datagrams of any kind that did not parse or belong
  std::int64_t lost = 0;               ///< by sequence numbers; negative with duplicates
  std::uint64_t refresh_requests = 0;  ///< PLI sent
};

}  // namespace atlaswire::client
