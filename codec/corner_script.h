#pragma once

#include "base/grid.h"
#include "codec/forecast.h"
#include "codec/gate_state.h"
#include "codec/meta_update.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>

namespace atlaswire::codec {

/// What is known of a new patch's corner when its turn comes.
struct ExpectedCorner {
  std::uint32_t previous = VertexTable::kNone;   ///< the corner before, if any
  std::uint32_t following = VertexTable::kNone;  ///< the corner behind, if this one closes the outline
  GridOffset at{0};
  std::array<GridOffset, 2> beside{};  ///< vertices whose coordinates may come again
  std::uint32_t scale = 0;             ///< bit length of the gate's edge, at most 17; 18, 19: no gate
  bool attached = false;
  bool remembered = false;           ///< attached, and `at` is where shapes told before have it
  Forecast<3, 64> ways;              ///< from the gate alone
  Forecast<2, 16> recall;            ///< from memory, and the best of those ways
  std::optional<GateCorner> corner;  ///< for memory
};

/// One corner of a new patch, decision by decision, the same for both directions: a border vertex beside
/// those that are corners already, or a position relative to the expected one. docs/PROTOCOL.md, "Shapes".
template <class Coder>
class CornerScript {
 public:
  CornerScript(Coder& coder, GateState& state, const MetaLimits& limits)
      : coder_(&coder), state_(&state), models_(&state.models), limits_(&limits) {}

  /// The vertex, which is new to the state if its position is. `taken` are corners already; `wanted`, only
  /// when encoding, is the corner's position. kNone: nonsense was decoded, and `error` says what.
  std::uint32_t code(const ExpectedCorner& expected, std::span<const std::uint32_t> taken,
                     const GridPosition* wanted);
  [[nodiscard]] MetaError error() const { return error_; }

 private:
  struct Offer {
    std::uint32_t vertex = 0;
    std::uint32_t distance = 0;
    std::uint32_t kind = 0;  ///< 0: next on one border, 1: on both
  };
  struct Offers {
    std::array<Offer, 16> list{};
    std::uint32_t count = 0;
  };

  static constexpr std::uint32_t kNone = VertexTable::kNone;
  static constexpr std::uint32_t kMostTested = 8;  ///< gates looked at of a vertex's, which may be many

  void offer(Offers& offers, const ExpectedCorner& expected, std::span<const std::uint32_t> taken,
             std::uint32_t vertex) const;
  Offers offers_for(const ExpectedCorner& expected, std::span<const std::uint32_t> taken) const;
  GridPosition code_position(const ExpectedCorner& expected, const GridPosition* wanted);
  std::int32_t code_residual(PositionModels& models, std::uint32_t scale, std::uint32_t& size_class,
                             std::int32_t value);

  [[nodiscard]] GridOffset at(std::uint32_t vertex) const {
    return GridOffset(state_->vertices.position(vertex));
  }
  std::uint32_t fail(MetaError why) {
    error_ = why;
    return kNone;
  }

  Coder* coder_;
  GateState* state_;
  GateModels* models_;
  const MetaLimits* limits_;
  MetaError error_{};
};

template <class Coder>
void CornerScript<Coder>::offer(Offers& offers, const ExpectedCorner& expected,
                                std::span<const std::uint32_t> taken, std::uint32_t vertex) const {
  if (std::ranges::find(taken, vertex) != taken.end()) return;
  for (std::uint32_t i = 0; i < offers.count; ++i) {
    if (offers.list[i].vertex != vertex) continue;
    offers.list[i].kind = 1;
    return;
  }
  const Offer made{vertex, grid_distance(at(vertex), expected.at), 0};
  std::uint32_t place = offers.count++;
  for (; place > 0 && offers.list[place - 1].distance > made.distance; --place) {
    offers.list[place] = offers.list[place - 1];
  }
  offers.list[place] = made;
}

/// The border vertices next to those that are already corners, the likeliest first.
template <class Coder>
typename CornerScript<Coder>::Offers CornerScript<Coder>::offers_for(
    const ExpectedCorner& expected, std::span<const std::uint32_t> taken) const {
  const GateTable& gates = state_->gates;
  Offers offers;
  std::uint32_t tested = 0;
  if (expected.previous != kNone) {
    for (std::uint32_t g = gates.first_leaving(expected.previous); g != kNone && tested < kMostTested;
         g = gates.next_leaving(g), ++tested) {
      offer(offers, expected, taken, gates.gate(g).to);
    }
  }
  tested = 0;
  if (expected.following != kNone) {
    for (std::uint32_t g = gates.first_arriving(expected.following); g != kNone && tested < kMostTested;
         g = gates.next_arriving(g), ++tested) {
      offer(offers, expected, taken, gates.gate(g).from);
    }
  }
  offers.count = std::min(offers.count, 3U);
  return offers;
}

template <class Coder>
std::uint32_t CornerScript<Coder>::code(const ExpectedCorner& expected, std::span<const std::uint32_t> taken,
                                        const GridPosition* wanted) {
  const std::uint32_t wanted_vertex = wanted == nullptr ? kNone : state_->vertices.find(*wanted);
  const Offers offers = offers_for(expected, taken);
  for (std::uint32_t i = 0; i < offers.count; ++i) {
    const Offer& offered = offers.list[i];
    const int relative =
        static_cast<int>(std::bit_width(offered.distance)) - static_cast<int>(expected.scale) + 6;
    const auto near = static_cast<std::uint32_t>(
        std::clamp(relative, 0, static_cast<int>(GateModels::kDistanceClasses) - 1));
    const std::uint32_t closes = expected.following != kNone ? 1 + offered.kind : 0;
    AdaptiveBit& model = models_->corner[((i * GateModels::kDistanceClasses + near) * 3 + closes) * 2 +
                                         static_cast<std::uint32_t>(expected.attached)];
    if (coder_->code(model, wanted_vertex == offered.vertex)) return offered.vertex;
  }
  const GridPosition position = code_position(expected, wanted);
  const std::uint32_t top = (1U << limits_->grid_bits) - 1;
  if (position.x > top || position.y > top || position.z > top) {
    return fail(MetaError::kBadPosition);
  }
  const std::uint32_t vertex = state_->vertices.find(position);
  if (vertex != kNone) return vertex;
  if (state_->vertices.size() >= limits_->max_vertices) {
    return fail(MetaError::kIdOutOfRange);
  }
  state_->mix(position.x);
  state_->mix(position.y);
  state_->mix(position.z);
  return state_->vertices.add(position);
}

/// Axis by axis: equal to the expected coordinate or to that of a vertex beside, or a difference to the
/// expected.
template <class Coder>
GridPosition CornerScript<Coder>::code_position(const ExpectedCorner& expected, const GridPosition* wanted) {
  PositionModels& models = models_->position[expected.remembered ? 2 : expected.attached ? 1 : 0];
  GridPosition position{0};
  std::uint32_t hits = 0;
  std::uint32_t size_class = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t want = wanted == nullptr ? 0 : static_cast<std::int32_t>((*wanted)[axis]);
    const std::array<std::int32_t, 3> offered{expected.at[axis], expected.beside[0][axis],
                                              expected.beside[1][axis]};
    bool hit = false;
    for (std::uint32_t i = 0; i < 3 && !hit; ++i) {
      if (std::find(offered.begin(), offered.begin() + i, offered[i]) != offered.begin() + i) continue;
      AdaptiveBit& model = models.equals[((i * PositionModels::kScales + expected.scale) * 3 + hits) * 3 +
                                         static_cast<std::uint32_t>(axis)];
      hit = coder_->code(model, want == offered[i]);
      if (hit) position[axis] = static_cast<std::uint32_t>(offered[i]);
    }
    hits = hit ? std::min(2U, hits + 1) : 0;
    if (hit) {
      size_class = 0;
      continue;
    }
    const std::int32_t residual = code_residual(models, expected.scale, size_class, want - offered[0]);
    // What is negative becomes larger than any grid.
    position[axis] = static_cast<std::uint32_t>(offered[0]) + static_cast<std::uint32_t>(residual);
  }
  return position;
}

/// `size_class` goes from axis to axis: how large the difference was for the scale.
template <class Coder>
std::int32_t CornerScript<Coder>::code_residual(PositionModels& models, std::uint32_t scale,
                                                std::uint32_t& size_class, std::int32_t value) {
  const auto size = static_cast<std::uint32_t>(std::abs(value));
  const std::uint32_t length =
      models.length[scale * 3 + size_class].code(*coder_, static_cast<std::uint32_t>(std::bit_width(size)));
  size_class = length == 0 ? 0 : length + 2 < scale ? 1 : 2;
  if (length == 0) return 0;
  const auto magnitude = static_cast<std::int32_t>(
      AdaptiveUnsigned::code_below_leading(*coder_, models.mantissa[length], length, size));
  return coder_->code_raw(value < 0 ? 1 : 0, 1) != 0 ? -magnitude : magnitude;
}

}  // namespace atlaswire::codec
