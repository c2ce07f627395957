#include "proto/framing.h"

#include "base/assert.h"

namespace atlaswire::proto {

namespace {
constexpr std::size_t kPrefix = 4;
}

void FrameReader::feed(ByteView bytes) {
  if (broken_) return;
  if (taken_ > 0) {
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(taken_));
    taken_ = 0;
  }
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

Result<std::optional<ByteView>> FrameReader::next() {
  if (broken_) return WireError::kBadLength;
  const ByteView held = ByteView(buffer_).subspan(taken_);
  if (held.size() < kPrefix) return std::optional<ByteView>{};
  const auto length = ByteReader(held).read<std::uint32_t>();
  if (length == 0 || length > limit_) {
    broken_ = true;
    buffer_ = {};
    taken_ = 0;
    return Error(WireError::kBadLength,
                 "envelope of " + std::to_string(length) + " octets, limit " + std::to_string(limit_));
  }
  if (held.size() - kPrefix < length) return std::optional<ByteView>{};
  taken_ += kPrefix + length;
  return std::optional<ByteView>{held.subspan(kPrefix, length)};
}

void append_frame(ByteView envelope, ByteBuffer& out) {
  AW_ASSERT(!envelope.empty() && envelope.size() <= kMaxEnvelope);
  ByteWriter writer(out);
  writer.write(static_cast<std::uint32_t>(envelope.size()));
  writer.write_bytes(envelope);
}

}  // namespace atlaswire::proto
