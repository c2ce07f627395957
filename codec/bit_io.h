#pragma once

#include "base/bytes.h"

#include <cstddef>
#include <cstdint>

namespace atlaswire::codec {

/// 0, -1, 1, -2, ... as 0, 1, 2, 3, ..., for signed numbers that are mostly small.
constexpr std::uint32_t zigzag(std::int32_t v) {
  return static_cast<std::uint32_t>(v) << 1U ^ static_cast<std::uint32_t>(v >> 31);
}
constexpr std::int32_t unzigzag(std::uint32_t v) {
  return static_cast<std::int32_t>(v >> 1U) ^ -static_cast<std::int32_t>(v & 1U);
}

/// Appends bits to a buffer it borrows, the highest of each number first.
class BitWriter {
 public:
  explicit BitWriter(ByteBuffer& out) : out_(&out) {}

  /// The low `count` bits of `value`, 0..32.
  void write(std::uint32_t value, std::uint32_t count);
  /// Exponential-Golomb code of order `order`, 0..31: value + 2^order in binary, behind as many zeros as it
  /// has bits beyond order + 1.
  void write_golomb(std::uint32_t value, std::uint32_t order);
  /// Zeros up to a whole octet.
  void finish();

  /// Bits that `write_golomb` takes.
  static std::uint32_t golomb_length(std::uint32_t value, std::uint32_t order);

 private:
  ByteBuffer* out_;
  std::uint64_t waiting_ = 0;  ///< the low `count_` bits
  std::uint32_t count_ = 0;    ///< below 8 between calls
};

/// The other end. Safe on hostile bytes: past the end every read gives 0 and `ok()` turns false for good.
class BitReader {
 public:
  explicit BitReader(ByteView bytes) : bytes_(bytes) {}

  std::uint32_t read(std::uint32_t count);
  /// A code for more than 32 bits is no code: not ok().
  std::uint32_t read_golomb(std::uint32_t order);

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::uint64_t bits_left() const { return std::uint64_t{bytes_.size()} * 8 - at_; }
  /// Everything was read but zeros up to a whole octet.
  [[nodiscard]] bool finished();

 private:
  ByteView bytes_;
  std::uint64_t at_ = 0;  ///< bits
  bool ok_ = true;
};

}  // namespace atlaswire::codec
