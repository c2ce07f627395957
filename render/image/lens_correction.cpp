#include "render/image/lens_correction.h"

#include <charconv>
#include <cmath>
#include <vector>

namespace atlaswire::render {

namespace {

/// Green as in the Rift DK1's published coefficients; red is refracted less and blue more.
constexpr LensCorrection kGeneric{{{{0.215, 0.235}, {0.22, 0.24}, {0.228, 0.248}}}};
constexpr double kMost = 10;

}  // namespace

Result<LensCorrection> parse_lens(std::string_view text) {
  if (text == "none") return LensCorrection{};
  if (text == "generic") return kGeneric;
  const Error bad{LensError::kBadLens, "'" + std::string(text) + "'"};
  std::vector<double> numbers;
  for (const char *at = text.data(), *end = at + text.size();; ++at) {
    double number = 0;
    const auto [rest, failed] = std::from_chars(at, end, number);
    if (failed != std::errc{} || !(std::abs(number) <= kMost)) return bad;
    numbers.push_back(number);
    at = rest;
    if (at == end) break;
    if (*at != ',') return bad;
  }
  if (numbers.size() != 2 && numbers.size() != 6) return bad;
  LensCorrection lens;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t first = numbers.size() == 6 ? 2 * c : 0;
    lens.channels[c] = {numbers[first], numbers[first + 1]};
  }
  return lens;
}

std::string to_string(const LensCorrection& lens) {
  if (lens == LensCorrection{}) return "none";
  if (lens == kGeneric) return "generic";
  std::string text;
  for (const RadialCorrection& channel : lens.channels) {
    for (const double k : {channel.k1, channel.k2}) {
      std::array<char, 32> digits{};
      const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), k);
      text.append(text.empty() ? "" : ",").append(digits.data(), written.ptr);
    }
  }
  return text;
}

const char* error_text(LensError e) {
  switch (e) {
    case LensError::kBadLens:
      return "no lens: none, generic, K1,K2, or K1,K2 of red, green and blue, each within +-10";
  }
  return "unknown lens error";
}

}  // namespace atlaswire::render
