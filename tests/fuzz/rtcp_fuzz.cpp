#include "base/assert.h"
#include "proto/rtcp.h"

#include <cstddef>
#include <cstdint>

/// What parses as RTCP and begins with a report must compose, and parse to the same packets again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace atlaswire;
  const auto packets = proto::parse_rtcp(std::as_bytes(std::span(data, size)));
  if (packets.has_error()) return 0;
  ByteBuffer out;
  proto::encode_rtcp(*packets, out);
  const auto again = proto::parse_rtcp(out);
  AW_ASSERT(again.has_value() && *again == *packets);
  return 0;
}
