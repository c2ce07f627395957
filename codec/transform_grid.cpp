#include "codec/transform_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace atlaswire::codec {

namespace {

/// Largest whole number whose square is at most `n`, n < 2^50.
std::int64_t root(std::int64_t n) {
  auto guess = static_cast<std::int64_t>(std::sqrt(static_cast<double>(n)));
  while (guess * guess > n) --guess;
  while ((guess + 1) * (guess + 1) <= n) ++guess;
  return guess;
}

}  // namespace

std::optional<GridTransform> TransformGrid::quantize(const RigidTransform& transform) const {
  GridTransform out;
  for (int axis = 0; axis < 3; ++axis) {
    const double steps = std::round(transform.translation[axis] / step);
    if (!(std::abs(steps) <= kFarthest)) return std::nullopt;
    out.translation[axis] = static_cast<std::int32_t>(steps);
  }
  const glm::dquat& q = transform.orientation;
  std::array<double, 4> members{q.x, q.y, q.z, q.w};
  double square = 0;
  for (const double m : members) square += m * m;
  if (!(square >= 0.25 && square <= 4.0)) return std::nullopt;
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (i == 0 || std::abs(members[i]) > std::abs(members[out.largest])) out.largest = i;
  }
  const double scale = std::copysign(std::ldexp(1.0, static_cast<int>(rotation_bits)) / std::sqrt(square),
                                     members[out.largest]);
  for (std::uint32_t i = 0; i < 4; ++i)
    out.rotation[i] = static_cast<std::int32_t>(std::round(members[i] * scale));
  // Three members of at most 1/sqrt(2) each, of which two at most are that large, always leave something.
  if (!complete(out)) return std::nullopt;
  return out;
}

RigidTransform TransformGrid::transform(const GridTransform& t) const {
  const double unit = std::ldexp(1.0, -static_cast<int>(rotation_bits));
  std::array<double, 4> members{};
  double left = 1.0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (i == t.largest) continue;
    members[i] = t.rotation[i] * unit;
    left -= members[i] * members[i];
  }
  members[t.largest] = std::sqrt(std::max(0.0, left));
  return {.translation = glm::dvec3(t.translation) * step,
          .orientation = glm::normalize(glm::dquat(members[3], members[0], members[1], members[2]))};
}

GridTransform TransformGrid::rest() const {
  GridTransform out;
  out.rotation[3] = 1 << rotation_bits;
  return out;
}

bool TransformGrid::complete(GridTransform& t) const {
  std::int64_t left = std::int64_t{1} << (2 * rotation_bits);
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (i != t.largest) left -= std::int64_t{t.rotation[i]} * t.rotation[i];
  }
  if (left < 0) return false;
  t.rotation[t.largest] = static_cast<std::int32_t>(root(left));
  return true;
}

double TransformGrid::max_translation_error() const { return 0.5 * std::sqrt(3.0) * step; }

double TransformGrid::max_rotation_error() const { return std::ldexp(4.0, -static_cast<int>(rotation_bits)); }

}  // namespace atlaswire::codec
