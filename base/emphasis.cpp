#include "base/emphasis.h"

#include <charconv>

namespace atlaswire {

Emphasis over(const Emphasis& wish, const Emphasis& own) {
  Emphasis both = own;
  if (wish.foveation) both.foveation = wish.foveation;
  both.priorities.insert(both.priorities.end(), wish.priorities.begin(), wish.priorities.end());
  return both;
}

std::optional<SurfacePriority> parse_surface_priority(std::string_view text) {
  const auto equals = text.rfind('=');
  if (equals == std::string_view::npos || equals == 0 || equals > Emphasis::kMostName) return std::nullopt;
  const char* end = text.data() + text.size();
  double octaves = 0;
  const auto parsed = std::from_chars(text.data() + equals + 1, end, octaves);
  const bool in_range = octaves >= -Emphasis::kMostOctaves && octaves <= Emphasis::kMostOctaves;
  if (parsed.ec != std::errc{} || parsed.ptr != end || !in_range) return std::nullopt;
  return SurfacePriority{std::string(text.substr(0, equals)), octaves};
}

}  // namespace atlaswire
