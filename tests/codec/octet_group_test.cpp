#include "codec/octet_group.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace atlaswire::codec {
namespace {

using Octets = std::array<std::uint8_t, OctetGroup::kSize>;

/// Around every threshold, in every place.
Octets some_octets(std::mt19937& random) {
  constexpr std::array<std::uint8_t, 12> kValues{0, 1, 7, 8, 15, 16, 31, 32, 127, 128, 254, 255};
  const bool high = random() % 2 == 0;
  Octets octets{};
  for (std::uint8_t& octet : octets) octet = kValues[high ? 3 + random() % 9 : random() % kValues.size()];
  return octets;
}

TEST(OctetGroup, DoesWhatOneByOneWould) {
  std::mt19937 random(7);
  for (int round = 0; round < 20000; ++round) {
    const Octets octets = some_octets(random);
    const OctetGroup group = OctetGroup::load(octets.data());
    std::uint32_t bits = 0;
    Octets counted = octets;
    Octets repeated = octets;
    for (std::uint32_t i = 0; i < OctetGroup::kSize; ++i) {
      bits |= (octets[i] & 1U) << i;
      if (counted[i] != 255) ++counted[i];
      const std::uint32_t octet = octets[i];
      repeated[i] = static_cast<std::uint8_t>(octet << 1U | (octet & 1U));
    }
    EXPECT_EQ(group.lowest_bits(), bits);
    const std::uint8_t least = *std::ranges::min_element(octets);
    EXPECT_EQ(group.all_from_8_16_32(), least < 8 ? 0U : least < 16 ? 1U : least < 32 ? 2U : 3U);
    Octets out{};
    group.counted().store(out.data());
    EXPECT_EQ(out, counted);
    group.repeated().store(out.data());
    EXPECT_EQ(out, repeated);
  }
}

}  // namespace
}  // namespace atlaswire::codec
