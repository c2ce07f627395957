#include "base/bytes.h"

namespace atlaswire {

bool ByteReader::take(std::size_t count) {
  if (!ok_ || remaining() < count) {
    ok_ = false;
    at_ = bytes_.size();
    return false;
  }
  at_ += count;
  return true;
}

std::uint64_t ByteReader::read_varint() {
  std::uint64_t v = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const auto octet = read<std::uint8_t>();
    if (!ok_) return 0;
    const std::uint64_t bits = octet & 0x7FU;
    if (shift == 63 && bits > 1) break;
    v |= bits << shift;
    if ((octet & 0x80U) == 0) return v;
  }
  ok_ = false;
  return 0;
}

std::int64_t ByteReader::read_signed_varint() {
  const std::uint64_t raw = read_varint();
  return static_cast<std::int64_t>(raw >> 1U) ^ -static_cast<std::int64_t>(raw & 1U);
}

ByteView ByteReader::read_bytes(std::size_t count) {
  if (!take(count)) return {};
  return bytes_.subspan(at_ - count, count);
}

void ByteWriter::write_varint(std::uint64_t v) {
  while (v >= 0x80U) {
    out_->push_back(static_cast<std::byte>(v | 0x80U));
    v >>= 7U;
  }
  out_->push_back(static_cast<std::byte>(v));
}

void ByteWriter::write_signed_varint(std::int64_t v) {
  write_varint((static_cast<std::uint64_t>(v) << 1U) ^ static_cast<std::uint64_t>(v >> 63));
}

}  // namespace atlaswire
