#include "base/assert.h"
#include "proto/framing.h"
#include "proto/messages.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

/// The reliable channel as a socket gives it: octet 0 sets the chunk size, the rest is the TCP stream.
/// What parses must be sendable, and parse to the same bytes again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace atlaswire;
  if (size == 0) return 0;
  const std::size_t chunk = 1 + std::size_t{data[0]};
  proto::FrameReader reader;
  for (ByteView rest = std::as_bytes(std::span(data + 1, size - 1)); !rest.empty();) {
    const std::size_t taken = std::min(chunk, rest.size());
    reader.feed(rest.first(taken));
    rest = rest.subspan(taken);
    AW_ASSERT(reader.pending() <= proto::kMaxEnvelopeBeforeHello + 4 + chunk);
    for (auto envelope = reader.next(); envelope.has_value() && *envelope; envelope = reader.next()) {
      const auto message = proto::parse_message(**envelope);
      if (message.has_error()) continue;
      ByteBuffer once;
      ByteBuffer twice;
      proto::append_message(*message, once);
      const auto again = proto::parse_message(ByteView(once).subspan(4));
      AW_ASSERT(again.has_value());
      proto::append_message(*again, twice);
      AW_ASSERT(once == twice);
    }
  }
  return 0;
}
