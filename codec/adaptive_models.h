#pragma once

#include "codec/range_coder.h"

#include <array>
#include <bit>
#include <cstdint>

namespace atlaswire::codec {

/// Symbols of more than one bit out of adaptive decisions. Each `code` takes a RangeEncoder and the value, or
/// a RangeDecoder, and gives the value. docs/PROTOCOL.md, "Range coding", has their order of decisions.

/// A number below 2^Bits, the highest bit first; each bit in the context of those before it.
template <std::uint32_t Bits>
class AdaptiveTree {
 public:
  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t value = 0) {
    std::uint32_t node = 1;
    for (std::uint32_t i = Bits; i-- > 0;) {
      const bool bit = coder.code(nodes_[node], (value >> i & 1U) != 0);
      node = node << 1U | static_cast<std::uint32_t>(bit);
    }
    return node - (1U << Bits);
  }

 private:
  std::array<AdaptiveBit, std::size_t{1} << Bits> nodes_;
};

/// Any 31-bit number, small ones cheapest: its bit length as a tree, then the bits below the leading one, of
/// which the first two adapt (an adaptive Elias gamma code). Values of 2^31 and more must not be coded.
class AdaptiveUnsigned {
 public:
  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t value = 0) {
    const std::uint32_t length = length_.code(coder, static_cast<std::uint32_t>(std::bit_width(value)));
    return code_below_leading(coder, mantissa_[length], length, value);
  }

  /// The bits below the leading one of a number of `length` bits.
  template <class Coder>
  static std::uint32_t code_below_leading(Coder& coder, std::array<AdaptiveBit, 4>& models,
                                          std::uint32_t length, std::uint32_t value) {
    if (length < 2) return length;
    std::uint32_t result = 1;
    std::uint32_t left = length - 1;
    for (int i = 0; i < 2 && left > 0; ++i) {
      --left;
      // `result` is 1, then 2 or 3: a context of its own each.
      const bool bit = coder.code(models[result], (value >> left & 1U) != 0);
      result = result << 1U | static_cast<std::uint32_t>(bit);
    }
    return left == 0 ? result : result << left | coder.code_raw(value & ((1U << left) - 1), left);
  }

 private:
  AdaptiveTree<5> length_;
  std::array<std::array<AdaptiveBit, 4>, 32> mantissa_;
};

}  // namespace atlaswire::codec
