#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

namespace atlaswire::codec {

/// Eight octets at once, the first lowest.
class OctetGroup {
 public:
  static constexpr std::uint32_t kSize = 8;
  static_assert(std::endian::native == std::endian::little);

  static OctetGroup load(const std::uint8_t* octets) {
    OctetGroup group;
    std::memcpy(&group.octets_, octets, kSize);
    return group;
  }
  void store(std::uint8_t* octets) const { std::memcpy(octets, &octets_, kSize); }

  /// Bit 0 of each, the first's lowest.
  [[nodiscard]] std::uint32_t lowest_bits() const {
    return static_cast<std::uint32_t>((octets_ & kOnes) * 0x0102040810204080U >> 56U);
  }
  /// How many of 8, 16 and 32 all of them reach.
  [[nodiscard]] std::uint32_t all_from_8_16_32() const {
    const std::uint64_t from_32 = octets_ >> 5U | octets_ >> 6U | octets_ >> 7U;
    const std::uint64_t from_16 = from_32 | octets_ >> 4U;
    const std::uint64_t from_8 = from_16 | octets_ >> 3U;
    const auto all = [](std::uint64_t bits) { return static_cast<std::uint32_t>((bits & kOnes) == kOnes); };
    return all(from_8) + all(from_16) + all(from_32);
  }
  /// Each one up, but 255 stays.
  [[nodiscard]] OctetGroup counted() const {
    const std::uint64_t full = (octets_ & ((octets_ & ~kTops) + kOnes) & kTops) >> 7U;
    return OctetGroup(octets_ + kOnes - full);
  }
  /// Each moved up by a bit, bit 0 as it was.
  [[nodiscard]] OctetGroup repeated() const {
    return OctetGroup((octets_ & ~kTops) << 1U | (octets_ & kOnes));
  }

 private:
  static constexpr std::uint64_t kOnes = 0x0101010101010101U;
  static constexpr std::uint64_t kTops = kOnes << 7U;

  OctetGroup() = default;
  explicit OctetGroup(std::uint64_t octets) : octets_(octets) {}

  std::uint64_t octets_ = 0;
};

}  // namespace atlaswire::codec
