#pragma once

#include "codec/motion_fit.h"
#include "codec/motion_state.h"
#include "codec/motion_surface.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace atlaswire::codec {

/// Where a frame's vertices are, decision by decision, the same for both directions: with a RangeEncoder it
/// is told the positions, with a RangeDecoder it finds out. docs/PROTOCOL.md, "Vertices". Each is predicted
/// from its own past and from neighbours that came before it; vertices are taken in groups of sixteen, so
/// that a group at rest costs one decision.
template <class Coder>
class VertexMotionScript {
 public:
  /// Displaced coordinates may lie in -2^grid_bits..2^(grid_bits + 1) - 1. `fit`, only when encoding: learns.
  VertexMotionScript(Coder& coder, MotionState& state, const MotionSurface& surface, std::uint32_t grid_bits,
                     MotionFit* fit)
      : coder_(&coder),
        state_(&state),
        models_(&state.models),
        surface_(&surface),
        low_(-(1 << grid_bits)),
        high_((2 << grid_bits) - 1),
        fit_(fit) {}

  /// `wanted`: one position a vertex, only when encoding. False: a position that is none was decoded.
  bool code(std::span<const std::uint32_t> vertices, std::span<const glm::ivec3> wanted);

 private:
  static constexpr std::size_t kGroup = 16;
  static constexpr std::size_t kMostTeachers = 1000;
  /// An age from which on weights make the prediction.
  static constexpr std::uint8_t kFull = VertexTrack::kOldest - 1;
  /// Parts of a step that predictions come in: 1024ths of a mean of up to four.
  static constexpr std::int32_t kParts = MotionWeights::kOne * 12;

  /// Neighbours that came before in this frame and have been there long enough.
  struct Nearby {
    std::array<const VertexTrack*, MotionSurface::kMostNeighbours> tracks{};
    std::array<std::uint32_t, MotionSurface::kMostNeighbours> vertices{};
    std::int32_t count = 0;
    [[nodiscard]] std::span<const VertexTrack* const> all() const {
      return {tracks.data(), static_cast<std::size_t>(count)};
    }
  };

  bool code_vertex(std::uint32_t vertex, const glm::ivec3* wanted);
  bool code_difference(std::uint32_t vertex, VertexTrack& track, const glm::ivec3* wanted);
  Nearby nearby(std::uint32_t vertex, std::uint8_t age) const;
  std::uint32_t neighbours_move(std::uint32_t vertex) const;
  Nearby predict(std::uint32_t vertex, const VertexTrack& track, std::array<std::int64_t, 3>& parts) const;
  void weigh(const VertexTrack& track, const Nearby& near, std::array<std::int64_t, 3>& parts) const;
  void learn(const VertexTrack& track, const Nearby& near, const glm::ivec3& velocity, double calmness);
  static std::array<std::int32_t, MotionWeights::kCount> features(const VertexTrack& track,
                                                                  const Nearby& near, int axis);
  static void rest(VertexTrack& track) {
    track.size = 0;
    track.jumped = false;
    track.push(track.at[0]);
  }

  Coder* coder_;
  MotionState* state_;
  MotionModels* models_;
  const MotionSurface* surface_;
  std::int32_t low_;
  std::int32_t high_;
  MotionFit* fit_;
  std::uint32_t learn_each_ = 1;  ///< of so many vertices one teaches
};

template <class Coder>
bool VertexMotionScript<Coder>::code(std::span<const std::uint32_t> vertices,
                                     std::span<const glm::ivec3> wanted) {
  if (vertices.size() > kMostTeachers) learn_each_ = 5;
  std::uint32_t flow = 0;
  for (std::size_t first = 0; first < vertices.size(); first += kGroup) {
    const std::size_t end = std::min(vertices.size(), first + kGroup);
    bool calm = true;
    bool moves = false;
    for (std::size_t i = first; i < end; ++i) {
      const VertexTrack& track = state_->vertices[vertices[i]];
      calm = calm && track.calm();
      moves = moves || (!wanted.empty() && wanted[i] != track.at[0]);
    }
    state_->mix(vertices[first]);
    if (calm) {
      moves = coder_->code(models_->calm_group[flow], moves);
      flow = moves ? 2 : flow == 2 ? 1 : 0;
      if (!moves) {
        for (std::size_t i = first; i < end; ++i) rest(state_->vertices[vertices[i]]);
        continue;
      }
    }
    for (std::size_t i = first; i < end; ++i) {
      if (!code_vertex(vertices[i], wanted.empty() ? nullptr : &wanted[i])) return false;
    }
  }
  return true;
}

template <class Coder>
bool VertexMotionScript<Coder>::code_vertex(std::uint32_t vertex, const glm::ivec3* wanted) {
  VertexTrack& track = state_->vertices[vertex];
  if (track.calm()) {
    AdaptiveBit& model = models_->calm[neighbours_move(vertex)];
    if (!coder_->code(model, wanted != nullptr && *wanted != track.at[0])) {
      rest(track);
      return true;
    }
  }
  if (track.jumped) {
    track.age = 1;
    track.jumped = false;
  }
  return code_difference(vertex, track, wanted);
}

template <class Coder>
bool VertexMotionScript<Coder>::code_difference(std::uint32_t vertex, VertexTrack& track,
                                                const glm::ivec3* wanted) {
  std::array<std::int64_t, 3> parts{};
  const Nearby near = predict(vertex, track, parts);
  std::uint32_t around = 0;
  for (const VertexTrack* other : near.all()) around += other->size;
  const auto count = static_cast<std::uint32_t>(near.count);
  const std::uint32_t size = track.size + 2 * (count == 0 ? track.size : around / count);
  const std::uint32_t nearby = track.age == 0   ? near.count == 0 ? 15 : 16
                               : track.age == 1 ? 17
                                                : DifferenceModels::class_of(size);
  glm::ivec3 position(0);
  glm::ivec3 difference(0);
  std::uint32_t before = 0;
  for (int axis = 0; axis < 3; ++axis) {
    Rounded expected = Rounded::of(parts[static_cast<std::size_t>(axis)], kParts);
    expected.clamp(low_, high_);
    const auto at = static_cast<std::int32_t>(expected.at);
    difference[axis] = models_->position.code(*coder_, nearby, before, expected.left, kParts,
                                              wanted == nullptr ? 0 : (*wanted)[axis] - at);
    before = std::max(before, difference[axis] != 0 ? 2U : 1U);
    const std::int64_t sum = std::int64_t{at} + difference[axis];
    if (sum < low_ || sum > high_) return false;
    position[axis] = static_cast<std::int32_t>(sum);
  }
  if (fit_ != nullptr && vertex % learn_each_ == 0 && track.age >= kFull && near.count > 0)
    learn(track, near, position - track.at[0], 1.0 / (4.0 + size * size));
  if (track.age >= 2)
    track.jumped = manhattan(position - 2 * track.at[0] + track.at[1]) > VertexTrack::kLoudest;
  track.size = static_cast<std::uint8_t>(std::min(VertexTrack::kLoudest, manhattan(difference)));
  track.push(position);
  state_->mix(position);
  return true;
}

/// Those that will be older than `age` when this frame is over.
template <class Coder>
typename VertexMotionScript<Coder>::Nearby VertexMotionScript<Coder>::nearby(std::uint32_t vertex,
                                                                             std::uint8_t age) const {
  Nearby near;
  for (const std::uint32_t other : surface_->neighbours(vertex)) {
    const VertexTrack& track = state_->vertices[other];
    if (track.age <= age) continue;
    near.tracks[static_cast<std::size_t>(near.count)] = &track;
    near.vertices[static_cast<std::size_t>(near.count++)] = other;
  }
  return near;
}

/// 0: none is there, 1: none of them moves, 2: one does.
template <class Coder>
std::uint32_t VertexMotionScript<Coder>::neighbours_move(std::uint32_t vertex) const {
  std::uint32_t move = 0;
  for (const std::uint32_t other : surface_->neighbours(vertex)) {
    const VertexTrack& track = state_->vertices[other];
    if (track.age > 0) move = std::max(move, track.at[0] == track.at[1] ? 1U : 2U);
  }
  return move;
}

/// In parts of a step. Gives the neighbours that it asked.
template <class Coder>
typename VertexMotionScript<Coder>::Nearby VertexMotionScript<Coder>::predict(
    std::uint32_t vertex, const VertexTrack& track, std::array<std::int64_t, 3>& parts) const {
  Nearby near;
  if (track.age >= kFull) near = nearby(vertex, kFull);
  const bool full = near.count > 0;
  if (!full) near = nearby(vertex, std::min<std::uint8_t>(track.age, 2));
  const std::int64_t share = near.count == 0 ? 0 : kParts / near.count;
  for (int axis = 0; axis < 3; ++axis) {
    std::int64_t& sum = parts[static_cast<std::size_t>(axis)];
    const bool moved_from_rest = track.age == 0 && near.count > 0;
    const std::int64_t from =
        moved_from_rest ? std::int64_t{surface_->rest(vertex)[axis]} : track.at[0][axis];
    sum = kParts * from;
    if (track.age >= 2 && !full) sum += kParts * (from - track.at[1][axis]);
  }
  if (full) {
    weigh(track, near, parts);
    return near;
  }
  for (std::int32_t i = 0; i < near.count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const VertexTrack& other = *near.tracks[index];
    glm::ivec3 moves = other.at[0];
    if (track.age == 0) {
      moves -= glm::ivec3(surface_->rest(near.vertices[index]));
    } else if (track.age == 1) {
      moves -= other.at[1];
    } else {
      moves += other.at[2] - 2 * other.at[1];
    }
    for (int axis = 0; axis < 3; ++axis) parts[static_cast<std::size_t>(axis)] += share * moves[axis];
  }
  return near;
}

/// In twelfths of a step: velocities of the neighbours now, the vertex's own last three, the neighbours' last
/// three.
template <class Coder>
std::array<std::int32_t, MotionWeights::kCount> VertexMotionScript<Coder>::features(const VertexTrack& track,
                                                                                    const Nearby& near,
                                                                                    int axis) {
  std::array<std::int32_t, MotionWeights::kCount> out{};
  for (std::size_t back = 0; back < 3; ++back)
    out[1 + back] = 12 * (track.at[back][axis] - track.at[back + 1][axis]);
  std::array<std::int32_t, 5> sums{};
  for (const VertexTrack* other : near.all()) {
    for (std::size_t back = 0; back < 5; ++back) sums[back] += other->at[back][axis];
  }
  const std::int32_t share = 12 / near.count;
  out[0] = share * (sums[0] - sums[1]);
  for (std::size_t back = 0; back < 3; ++back) out[4 + back] = share * (sums[back + 1] - sums[back + 2]);
  return out;
}

template <class Coder>
void VertexMotionScript<Coder>::weigh(const VertexTrack& track, const Nearby& near,
                                      std::array<std::int64_t, 3>& parts) const {
  const MotionWeights& weights = state_->weights[MotionModels::weight_set_of(track.size)];
  for (int axis = 0; axis < 3; ++axis) {
    const auto own = features(track, near, axis);
    for (std::size_t i = 0; i < own.size(); ++i)
      parts[static_cast<std::size_t>(axis)] += std::int64_t{weights.of[i]} * own[i];
  }
}

/// Neighbours in `near` may be too young to have asked for weights: then there is nothing to learn.
template <class Coder>
void VertexMotionScript<Coder>::learn(const VertexTrack& track, const Nearby& near,
                                      const glm::ivec3& velocity, double calmness) {
  for (const VertexTrack* other : near.all()) {
    if (other->age <= kFull) return;
  }
  const std::uint32_t set = MotionModels::weight_set_of(track.size);
  for (int axis = 0; axis < 3; ++axis) {
    const auto own = features(track, near, axis);
    MotionFit::Features steps{};
    for (std::size_t i = 0; i < own.size(); ++i) steps[i] = own[i] / 12.0;
    fit_->note(set, steps, velocity[axis], calmness);
  }
}

}  // namespace atlaswire::codec
