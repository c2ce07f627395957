#pragma once

#include <array>
#include <cstdint>
#include <glm/ext/quaternion_double.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace atlaswire::codec {

/// Where a rigid object is relative to where it rests: x -> orientation * x + translation, in the scene's
/// axes.
struct RigidTransform {
  glm::dvec3 translation{0.0};                 ///< metres
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};  ///< unit
};

/// The same in whole steps.
struct GridTransform {
  glm::ivec3 translation{0};
  /// x, y, z, w. The largest (the first of equals) is not negative, and its size follows from the others.
  std::array<std::int32_t, 4> rotation{};
  std::uint32_t largest = 3;

  bool operator==(const GridTransform&) const = default;
};

/// How finely transforms are told: the bounds of their errors.
struct TransformGrid {
  double step = 1e-3;                ///< metres between neighbouring translations, > 0
  std::uint32_t rotation_bits = 14;  ///< a quaternion's members are told in steps of 2^-bits, 8..20

  /// Translations reach this many steps from rest, along each axis.
  static constexpr std::int32_t kFarthest = 1 << 28;

  /// Nearest transform on the grid; nullopt: not finite, too far, or an orientation whose length is not
  /// within 0.5..2 (it is normalised).
  [[nodiscard]] std::optional<GridTransform> quantize(const RigidTransform& transform) const;
  [[nodiscard]] RigidTransform transform(const GridTransform& t) const;
  /// No rotation, no translation.
  [[nodiscard]] GridTransform rest() const;
  /// Gives `t.rotation[t.largest]` what the other three leave of a unit quaternion, rounded down. False: they
  /// leave nothing.
  [[nodiscard]] bool complete(GridTransform& t) const;

  /// Largest distance in metres between a translation and its grid point: sqrt(3)/2 * step.
  [[nodiscard]] double max_translation_error() const;
  /// Largest angle in radians between an orientation and the one told: 4 * 2^-bits. (Three members err by
  /// half a step each, d = sqrt(3)/2 steps together; the fourth, at least 1/2, adds at most as much again
  /// along the sphere: the quaternion errs by at most 2 d, the angle by twice that, 3.47 steps, and the arc
  /// exceeds its chord by less than the rest.)
  [[nodiscard]] double max_rotation_error() const;
};

}  // namespace atlaswire::codec
