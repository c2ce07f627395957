#pragma once

#include "base/bytes.h"
#include "base/ids.h"
#include "base/result.h"
#include "proto/tokens.h"
#include "proto/wire_error.h"

#include <cstddef>
#include <cstdint>

namespace atlaswire::proto {

/// What a datagram of the shared UDP flow is, by its first octets; docs/PROTOCOL.md, section 3.
enum class DatagramKind : std::uint8_t {
  kUnknown,
  kRtp,
  kRtcp,  ///< first octet 128..191 and second 192..223 (RFC 5761 section 4)
  kPose,
  kProbe,
  kChallenge,
  kConfirm,
  kSyncRequest,
  kSyncResponse
};

/// Never fails: whatever is nothing of ours is kUnknown. Only the first two octets are looked at.
DatagramKind classify(ByteView datagram);

/// Every message of ours starts with: type u8 | wire version u8 | session u32.
inline constexpr std::size_t kDatagramHeader = 6;
/// The session a datagram of ours names, so that the daemon finds it before parsing more.
Result<SessionId> session_of(ByteView datagram);

/// Times on the wire are nanoseconds since a clock's own zero, within +-kMaxWireNanos (36 years); parsers
/// refuse others, so that sums and differences of a few of them never overflow.
inline constexpr std::int64_t kMaxWireNanos = std::int64_t{1} << 60U;
[[nodiscard]] constexpr bool is_wire_time(std::int64_t nanos) {
  return nanos > -kMaxWireNanos && nanos < kMaxWireNanos;
}

/// Client to server: "I am at this address". Padded with zeros to kProbeSize, more than the answer's size.
struct Probe {
  SessionId session{};
  UdpToken token{};
};
/// Server to client: "prove that you receive here".
struct Challenge {
  SessionId session{};
  Nonce nonce{};
};
/// Client to server: the proof.
struct Confirm {
  SessionId session{};
  UdpToken token{};
  Nonce nonce{};
};
/// Client to server: a clock sync request, stamped by the client's clock at sending. Padded with zeros
/// to the response's size.
struct SyncRequest {
  SessionId session{};
  std::uint32_t sequence = 0;
  std::int64_t client_sent = 0;  ///< ns, client clock
};
/// Server to client.
struct SyncResponse {
  SessionId session{};
  std::uint32_t sequence = 0;
  std::int64_t client_sent = 0;      ///< ns, echoed
  std::int64_t server_received = 0;  ///< ns, server clock
  std::int64_t server_sent = 0;      ///< ns, server clock
};

inline constexpr std::size_t kProbeSize = 48;
inline constexpr std::size_t kChallengeSize = kDatagramHeader + 16;
inline constexpr std::size_t kConfirmSize = kDatagramHeader + 32;
inline constexpr std::size_t kSyncSize = kDatagramHeader + 28;

/// Each replaces `out`'s contents by the whole datagram.
void encode(const Probe& message, ByteBuffer& out);
void encode(const Challenge& message, ByteBuffer& out);
void encode(const Confirm& message, ByteBuffer& out);
void encode(const SyncRequest& message, ByteBuffer& out);
void encode(const SyncResponse& message, ByteBuffer& out);

/// Each refuses a wrong type, version, size, non-zero padding, session 0 and times that are none.
Result<Probe> parse_probe(ByteView datagram);
Result<Challenge> parse_challenge(ByteView datagram);
Result<Confirm> parse_confirm(ByteView datagram);
Result<SyncRequest> parse_sync_request(ByteView datagram);
Result<SyncResponse> parse_sync_response(ByteView datagram);

}  // namespace atlaswire::proto
