#include "base/units.h"

#include <charconv>
#include <cmath>
#include <string>

namespace atlaswire {

namespace {

constexpr std::uint32_t kMaxSide = 32768;

bool parse_side(std::string_view text, std::uint32_t& out) {
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), out);
  return ec == std::errc{} && end == text.data() + text.size() && out >= 1 && out <= kMaxSide;
}

}  // namespace

Duration BitRate::time_for(Bytes bytes) const {
  if (bits_per_second == 0) return Duration::max();
  return from_seconds(static_cast<double>(bytes.count) * 8.0 / static_cast<double>(bits_per_second));
}

Result<Extent2D> parse_extent(std::string_view text) {
  const auto cross = text.find('x');
  Extent2D extent;
  if (cross == std::string_view::npos || !parse_side(text.substr(0, cross), extent.width) ||
      !parse_side(text.substr(cross + 1), extent.height)) {
    return Error{units::UnitError::kBadExtent, "'" + std::string(text) + "'"};
  }
  return extent;
}

Result<BitRate> parse_bit_rate(std::string_view text) {
  const Error bad{units::UnitError::kBadBitRate, "'" + std::string(text) + "'"};
  double number = 0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (ec != std::errc{} || !std::isfinite(number) || number < 0) return bad;
  const std::string_view suffix(end, static_cast<std::size_t>(text.data() + text.size() - end));
  double scale = 1;
  if (suffix == "k" || suffix == "K") {
    scale = 1e3;
  } else if (suffix == "M") {
    scale = 1e6;
  } else if (suffix == "G") {
    scale = 1e9;
  } else if (!suffix.empty()) {
    return bad;
  }
  const double rate = number * scale;
  if (rate > 1e12) return bad;
  return BitRate{static_cast<std::uint64_t>(std::llround(rate))};
}

}  // namespace atlaswire

namespace atlaswire::units {

const char* error_text(UnitError e) {
  switch (e) {
    case UnitError::kBadExtent:
      return "not an extent; write WIDTHxHEIGHT with sides from 1 to 32768, like 1024x512";
    case UnitError::kBadBitRate:
      return "not a bit rate; write bits per second with k, M or G, like 10M";
  }
  return "unknown unit error";
}

}  // namespace atlaswire::units
