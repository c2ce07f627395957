#include "codec/shape_memory.h"

#include "codec/forecast.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

namespace atlaswire::codec {

namespace {

double dot(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

glm::dvec3 cross(const glm::dvec3& a, const glm::dvec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

std::uint64_t squared(const glm::ivec3& v) {
  const auto square = [](std::int32_t x) { return static_cast<std::uint64_t>(std::int64_t{x} * x); };
  return square(v.x) + square(v.y) + square(v.z);
}

/// 16 log2(x), by its leading five bits; 0 for 0. Below 2^10.
std::uint32_t log2_in_16ths(std::uint64_t x) {
  // round(16 log2(1 + i / 16))
  constexpr std::array<std::uint8_t, 16> kFraction{0, 1, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 15};
  if (x == 0) return 0;
  const auto octave = static_cast<std::uint32_t>(std::bit_width(x)) - 1;
  const std::uint64_t top = octave >= 4 ? x >> (octave - 4) : x << (4 - octave);
  return 16 * octave + kFraction[top & 15U];
}

}  // namespace

std::optional<GateFrame> GateFrame::over(const glm::ivec3& from, const glm::ivec3& to,
                                         const glm::ivec3& behind_from, const glm::ivec3& behind_to) {
  const glm::dvec3 edge(to - from);
  const double edge_squared = dot(edge, edge);
  if (edge_squared == 0) return std::nullopt;
  const glm::dvec3 behind = (glm::dvec3(behind_from - from) + glm::dvec3(behind_to - from)) * 0.5;
  const glm::dvec3 away = behind - edge * (dot(behind, edge) / edge_squared);
  const double away_squared = dot(away, away);
  if (away_squared < 1) return std::nullopt;
  const glm::dvec3 across = cross(edge, away);
  GateFrame frame;
  frame.origin_ = glm::dvec3(from);
  frame.axes_ = {Axis{edge, edge_squared}, Axis{away, away_squared}, Axis{across, dot(across, across)}};
  for (const glm::ivec3& length : {to - from, behind_from - from, behind_to - to}) {
    frame.lengths_ = frame.lengths_ << 10U | log2_in_16ths(squared(length));
  }
  return frame;
}

GateFrame::Place GateFrame::place(const glm::ivec3& position) const {
  const glm::dvec3 offset = glm::dvec3(position) - origin_;
  Place place{};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    place[i] = static_cast<float>(dot(offset, axes_[i].along) / axes_[i].squared);
  }
  return place;
}

glm::ivec3 GateFrame::position(const Place& place, std::int32_t top) const {
  glm::dvec3 at = origin_;
  for (std::size_t i = 0; i < axes_.size(); ++i) at += axes_[i].along * double{place[i]};
  glm::ivec3 position{0};
  for (int axis = 0; axis < 3; ++axis) {
    position[axis] = static_cast<std::int32_t>(std::clamp(std::floor(at[axis] + 0.5), 0.0, double(top)));
  }
  return position;
}

const GateFrame::Place* ShapeMemory::recall(const GateCorner& corner) const {
  if (entries_.empty()) return nullptr;
  const Key key = key_of(corner);
  const Entry& entry = entries_[key.entry];
  return entry.check == key.check && entry.holds ? &entry.place : nullptr;
}

void ShapeMemory::learn(const GateCorner& corner, const glm::ivec3& position) {
  if (entries_.empty()) entries_.resize(kSize);
  const Key key = key_of(corner);
  Entry& entry = entries_[key.entry];
  entry.holds = true;
  if (entry.known && entry.check == key.check) {
    constexpr std::int32_t kFar = 1 << 21;
    const glm::ivec3 foretold = corner.frame.position(entry.place, kFar);
    entry.holds = grid_distance(foretold, position) <= kMostMissed;
  }
  entry.known = true;
  entry.check = key.check;
  entry.place = corner.frame.place(position);
}

}  // namespace atlaswire::codec
