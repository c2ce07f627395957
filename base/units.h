#pragma once

#include "base/error_enum.h"
#include "base/result.h"
#include "base/time.h"

#include <compare>
#include <cstdint>
#include <string_view>

namespace atlaswire {

/// Width and height in pixels or texels.
struct Extent2D {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  auto operator<=>(const Extent2D&) const = default;
  [[nodiscard]] std::uint64_t area() const { return std::uint64_t{width} * height; }
};

/// A number of bytes on the wire or in memory.
struct Bytes {
  std::uint64_t count = 0;
  auto operator<=>(const Bytes&) const = default;
};

/// Bits per second.
struct BitRate {
  std::uint64_t bits_per_second = 0;
  auto operator<=>(const BitRate&) const = default;
  [[nodiscard]] double mbps() const { return static_cast<double>(bits_per_second) * 1e-6; }
  /// How long `bytes` take at this rate; Duration::max() at rate 0.
  [[nodiscard]] Duration time_for(Bytes bytes) const;
};

/// "1024x512" to an extent; both sides 1..32768.
Result<Extent2D> parse_extent(std::string_view text);

/// "10M", "800k", "2.5G" or plain bits per second, to a rate.
Result<BitRate> parse_bit_rate(std::string_view text);

}  // namespace atlaswire

namespace atlaswire::units {
/// What parsing a setting can say.
enum class UnitError { kBadExtent = 1, kBadBitRate };
const char* error_text(UnitError e);
}  // namespace atlaswire::units
ATLASWIRE_ERROR_ENUM(units, UnitError);
