#pragma once

#include "codec/resident_set.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace atlaswire::codec {

/// What foretells whether a resident comes or goes, as a number: how long it has been calm, whether it is
/// visible and how restless it was, how large its block is, and whether the one behind it is visible.
/// docs/PROTOCOL.md, "Presence".
class ResidentOutlook {
 public:
  static constexpr std::uint32_t kCount = 11 * 6 * 4 * 2;

  /// Below kCount. `next_visible`: 0 or 1, of the one behind it.
  static std::uint32_t of(const ResidentSet& residents, std::uint32_t index, std::uint32_t next_visible) {
    const Block& block = residents.block(index);
    const std::uint32_t unrest = kCalm[residents.calm(index)] * 6U + kUnrest[residents.history(index)];
    const std::uint32_t area = kArea[(block.width_log2 + block.height_log2) & 31U];
    return (unrest * 4 + area) * 2 + next_visible;
  }

 private:
  static constexpr std::array<std::uint8_t, 256> kCalm = [] {
    std::array<std::uint8_t, 256> classes{};
    for (std::size_t calm = 0; calm < 256; ++calm)
      classes[calm] = static_cast<std::uint8_t>(calm < 8 ? calm : calm < 16 ? 8 : calm < 32 ? 9 : 10);
    return classes;
  }();
  static constexpr std::array<std::uint8_t, 256> kUnrest = [] {
    std::array<std::uint8_t, 256> classes{};
    for (std::uint32_t history = 0; history < 256; ++history) {
      const int turns = std::popcount((history ^ history >> 1U) & 0x7FU);
      classes[history] =
          static_cast<std::uint8_t>((history & 1U) * 3 + static_cast<std::uint32_t>(turns < 2 ? turns : 2));
    }
    return classes;
  }();
  static constexpr std::array<std::uint8_t, 32> kArea = [] {
    std::array<std::uint8_t, 32> classes{};
    for (std::size_t log2 = 0; log2 < 32; ++log2)
      classes[log2] = static_cast<std::uint8_t>(log2 <= 2 ? 0 : log2 <= 4 ? 1 : log2 <= 6 ? 2 : 3);
    return classes;
  }();
};

}  // namespace atlaswire::codec
