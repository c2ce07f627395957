#include "codec/range_coder.h"

namespace atlaswire::codec {

std::uint32_t RangeEncoder::code_raw(std::uint32_t value, std::uint32_t count) {
  for (std::uint32_t i = count; i-- > 0;) {
    range_ >>= 1U;
    if ((value >> i & 1U) != 0) low_ += range_;
    while (range_ < kRenormalize) shift();
  }
  return value;
}

/// Moves the top octet out of `low_`. An octet of 0xFF waits, because a carry would run through it.
void RangeEncoder::shift() {
  const bool carry = low_ > 0xFFFFFFFF;
  const auto top = static_cast<std::uint8_t>(low_ >> 24U);
  if (carry || top != 0xFF) {
    const std::uint8_t add = carry ? 1 : 0;
    if (has_cache_) out_->push_back(static_cast<std::byte>(cache_ + add));
    for (; pending_ != 0; --pending_) out_->push_back(static_cast<std::byte>(0xFF + add));
    cache_ = top;
    has_cache_ = true;
  } else {
    ++pending_;
  }
  low_ = (low_ & 0x00FFFFFF) << 8U;
  range_ <<= 8U;
}

void RangeEncoder::finish() {
  // Any value in [low, low + range) will do: the one with the most zeros at its end.
  for (std::uint32_t zeros = 32; zeros >= 8; zeros -= 8) {
    const std::uint64_t mask = (std::uint64_t{1} << zeros) - 1;
    const std::uint64_t rounded = (low_ + mask) & ~mask;
    if (rounded >= low_ + range_) continue;
    low_ = rounded;
    break;
  }
  for (int octet = 0; octet < 5; ++octet) shift();
  while (out_->size() > start_ && out_->back() == std::byte{0}) out_->pop_back();
}

RangeDecoder::RangeDecoder(ByteView bytes) : bytes_(bytes) {
  for (int octet = 0; octet < 4; ++octet) code_ = code_ << 8U | next_octet();
}

std::uint32_t RangeDecoder::code_raw(std::uint32_t, std::uint32_t count) {
  std::uint32_t value = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    range_ >>= 1U;
    const bool bit = code_ >= range_;
    if (bit) code_ -= range_;
    value = value << 1U | static_cast<std::uint32_t>(bit);
    while (range_ < kRenormalize) shift();
  }
  return value;
}

}  // namespace atlaswire::codec
