#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace atlaswire {

/// Atlas area that a surface gets beside what its size on screen asks for, by the name of its material or
/// object; where both are named, they add up.
struct SurfacePriority {
  std::string name;
  double octaves = 0;  ///< -8..8; above 0: sharper
  bool operator==(const SurfacePriority&) const = default;
};

/// What a viewer or an operator wants sharper than the rest ([SAS] 4.3: other objectives that bias levels).
struct Emphasis {
  static constexpr double kMostFoveation = 8;
  static constexpr double kMostOctaves = 8;
  static constexpr std::size_t kMostPriorities = 256;
  static constexpr std::size_t kMostName = 128;  ///< octets

  /// Octaves of atlas area that surfaces lose per radian away from the view axis, 0..8; nullopt: no opinion.
  std::optional<double> foveation;
  std::vector<SurfacePriority>
      priorities;  ///< of two with one name the later counts; unknown names do nothing

  bool operator==(const Emphasis&) const = default;
};

/// `own`, where `wish` says nothing.
Emphasis over(const Emphasis& wish, const Emphasis& own);

/// "NAME=OCTAVES", the name 1 to 128 octets; empty when it is not that.
std::optional<SurfacePriority> parse_surface_priority(std::string_view text);

}  // namespace atlaswire
