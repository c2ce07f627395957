#pragma once

#include "base/bytes.h"
#include "base/result.h"
#include "proto/wire_error.h"

#include <cstdint>
#include <optional>

namespace atlaswire::proto {

/// Largest envelope before and after the peer is authenticated, in octets; docs/PROTOCOL.md, section 2.
inline constexpr std::uint32_t kMaxEnvelopeBeforeHello = 64U * 1024U;
inline constexpr std::uint32_t kMaxEnvelope = 8U * 1024U * 1024U;

/// Cuts a TCP byte stream into envelopes: `u32 length | envelope`, big-endian, length 1..limit.
/// Safe on hostile bytes: never holds more than one envelope's limit and the last chunk fed. Take
/// everything with `next` after each `feed`.
class FrameReader {
 public:
  explicit FrameReader(std::uint32_t limit = kMaxEnvelopeBeforeHello) : limit_(limit) {}

  /// Applies to lengths read from now on.
  void set_limit(std::uint32_t limit) { limit_ = limit; }
  /// Bytes as they came from the socket, in order, any size. Ignored after an error.
  void feed(ByteView bytes);
  /// The next whole envelope, borrowed until the next call of `feed` or `next`; nullopt when more bytes
  /// are needed. kBadLength for a zero or oversize length, and for ever after: close the connection.
  Result<std::optional<ByteView>> next();
  /// Octets held that are no whole envelope yet.
  [[nodiscard]] std::size_t pending() const { return buffer_.size() - taken_; }

 private:
  std::uint32_t limit_;
  ByteBuffer buffer_;
  std::size_t taken_ = 0;
  bool broken_ = false;
};

/// Appends the length prefix and the envelope's octets to `out`; the envelope holds 1..kMaxEnvelope octets.
void append_frame(ByteView envelope, ByteBuffer& out);

}  // namespace atlaswire::proto
