#include "codec/bit_io.h"

#include <algorithm>
#include <bit>

namespace atlaswire::codec {

void BitWriter::write(std::uint32_t value, std::uint32_t count) {
  const std::uint64_t mask = (std::uint64_t{1} << count) - 1;
  waiting_ = waiting_ << count | (value & mask);
  count_ += count;
  while (count_ >= 8) {
    count_ -= 8;
    out_->push_back(static_cast<std::byte>(waiting_ >> count_ & 0xFFU));
  }
}

void BitWriter::write_golomb(std::uint32_t value, std::uint32_t order) {
  const std::uint64_t code = std::uint64_t{value} + (std::uint64_t{1} << order);
  const auto length = static_cast<std::uint32_t>(std::bit_width(code));  // at most 33
  write(0, length - order - 1);
  write(static_cast<std::uint32_t>(code >> (length - 1)), 1);
  write(static_cast<std::uint32_t>(code), length - 1);
}

void BitWriter::finish() {
  if (count_ != 0) write(0, 8 - count_);
}

std::uint32_t BitWriter::golomb_length(std::uint32_t value, std::uint32_t order) {
  const std::uint64_t code = std::uint64_t{value} + (std::uint64_t{1} << order);
  return 2 * static_cast<std::uint32_t>(std::bit_width(code)) - order - 1;
}

std::uint32_t BitReader::read(std::uint32_t count) {
  if (count > bits_left()) {
    ok_ = false;
    at_ = std::uint64_t{bytes_.size()} * 8;
    return 0;
  }
  std::uint64_t value = 0;
  for (std::uint32_t left = count; left > 0;) {
    const auto inside = static_cast<std::uint32_t>(at_ & 7U);
    const std::uint32_t taken = std::min(left, 8 - inside);
    const auto octet = std::to_integer<std::uint32_t>(bytes_[static_cast<std::size_t>(at_ >> 3U)]);
    value = value << taken | (octet >> (8 - inside - taken) & ((1U << taken) - 1));
    at_ += taken;
    left -= taken;
  }
  return static_cast<std::uint32_t>(value);
}

std::uint32_t BitReader::read_golomb(std::uint32_t order) {
  std::uint32_t zeros = 0;
  while (ok_ && read(1) == 0) {
    if (++zeros + order > 32) ok_ = false;
  }
  if (!ok_) return 0;
  const std::uint32_t length = zeros + order;  // below the leading one; at most 32
  const std::uint64_t code = std::uint64_t{1} << length | read(length);
  const std::uint64_t value = code - (std::uint64_t{1} << order);
  if (value > 0xFFFFFFFF) ok_ = false;
  return ok_ ? static_cast<std::uint32_t>(value) : 0;
}

bool BitReader::finished() {
  if (!ok_ || bits_left() >= 8) return false;
  return read(static_cast<std::uint32_t>(bits_left())) == 0;
}

}  // namespace atlaswire::codec
