#pragma once

#include "base/grid.h"
#include "codec/corner_script.h"
#include "codec/gate_offers.h"
#include "codec/gate_state.h"
#include "codec/level_script.h"
#include "codec/meta_update.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace atlaswire::codec {

/// A patch that an encoder wants to make known.
struct WantedPatch {
  PatchId id{};
  std::uint8_t triangles = 1;
  PatchClass draw;
  std::array<GridPosition, kMaxPatchCorners> positions{};
  Block block;
};

/// Shapes and block sizes of patches never seen before, decision by decision, the same for both directions:
/// with a RangeEncoder it is told each patch, with a RangeDecoder it finds out. docs/PROTOCOL.md, "Shapes". A
/// patch is attached to a gate of a patch near in number, if one fits; its other corners are border vertices
/// beside it or positions relative to where the surface would go on.
template <class Coder>
class ShapeScript {
 public:
  ShapeScript(Coder& coder, GateState& state, const MetaLimits& limits)
      : coder_(&coder),
        state_(&state),
        models_(&state.models),
        limits_(&limits),
        corners_(coder, state, limits) {}

  /// The next patch in ascending order of ids, its block without a position. nullopt: nonsense was decoded,
  /// and `error` says what.
  std::optional<NewResident> code(std::span<const NewResident> before, const WantedPatch* wanted);
  [[nodiscard]] MetaError error() const { return error_; }

 private:
  using Offset = GridOffset;
  struct Attached {
    const Gate* gate = nullptr;  ///< null: to none
    std::uint32_t triangles = 1;
    std::uint32_t edge = 0;
  };
  static constexpr std::uint32_t kNone = VertexTable::kNone;

  bool code_id(const WantedPatch* wanted, NewResident& patch);
  void look_around(std::span<const NewResident> before);
  bool code_class(const WantedPatch* wanted, PatchShape& shape);
  Attached code_gate(std::span<const NewResident> before, const PatchShape& shape, const WantedPatch* wanted);
  std::uint32_t fitting_gate(GateOffers offers, const WantedPatch& wanted) const;
  bool code_corners(const Attached& attached, const WantedPatch* wanted, PatchShape& shape);
  ExpectedCorner expect(const Gate* gate, const PatchShape& shape, std::uint32_t turn, std::uint32_t step);
  const Gate* gate_between(std::uint32_t from, std::uint32_t to) const {
    const std::uint32_t number = state_->gates.find(from, to);
    return number == GateTable::kNone ? nullptr : &state_->gates.gate(number);
  }
  void expect_attached(const Gate& gate, const PatchShape& shape, std::uint32_t turn, std::uint32_t step,
                       ExpectedCorner& expected);
  void expect_remembered(const GateCorner& corner, ExpectedCorner& expected);
  void expect_alone(const PatchShape& shape, std::uint32_t step, ExpectedCorner& expected);

  /// The grid's largest coordinate.
  [[nodiscard]] std::int32_t top() const { return static_cast<std::int32_t>((1U << limits_->grid_bits) - 1); }
  [[nodiscard]] Offset at(std::uint32_t vertex) const { return Offset(state_->vertices.position(vertex)); }
  bool fail(MetaError why) {
    error_ = why;
    return false;
  }

  Coder* coder_;
  GateState* state_;
  GateModels* models_;
  const MetaLimits* limits_;
  CornerScript<Coder> corners_;
  NearPatches near_{};
  std::uint32_t gap_class_ = 2;
  std::uint32_t attached_flow_ = 7;  ///< whether each of the three patches before was, the last in bit 0
  std::uint32_t next_id_ = 0;        ///< the least that may come
  std::uint32_t next_resident_ = 0;  ///< index of the first resident not below it
  MetaError error_{};
};

template <class Coder>
std::optional<NewResident> ShapeScript<Coder>::code(std::span<const NewResident> before,
                                                    const WantedPatch* wanted) {
  NewResident patch;
  if (!code_id(wanted, patch)) return std::nullopt;
  look_around(before);
  if (!code_class(wanted, patch.shape)) return std::nullopt;
  const Attached attached = code_gate(before, patch.shape, wanted);
  if (!code_corners(attached, wanted, patch.shape)) return std::nullopt;
  const auto block =
      code_level(*coder_, models_->new_level, near_[0].block, wanted ? &wanted->block : nullptr);
  if (!block) {
    fail(MetaError::kBadBlock);
    return std::nullopt;
  }
  patch.block = *block;
  state_->gates.add(outline_of(patch.shape));
  state_->mix(value(patch.id));
  for (std::uint32_t i = 0; i < corner_count(patch.shape.triangles); ++i) state_->mix(patch.shape.corners[i]);
  return patch;
}

/// Ids of patches that are known already do not count in a gap.
template <class Coder>
bool ShapeScript<Coder>::code_id(const WantedPatch* wanted, NewResident& patch) {
  const ResidentSet& residents = state_->residents;
  std::uint32_t gap = 0;
  if (wanted != nullptr) {
    const std::uint32_t at = residents.lower_bound(wanted->id);
    gap = value(wanted->id) - next_id_ - (at - next_resident_);
  }
  gap = models_->gap[gap_class_].code(*coder_, gap);
  gap_class_ = gap == 0 ? 0 : gap < 16 ? 1 : 2;
  if (gap >= limits_->max_patches) return fail(MetaError::kIdOutOfRange);
  std::uint64_t id = std::uint64_t{next_id_} + gap;
  for (; next_resident_ < residents.size() && value(residents.id(next_resident_)) <= id; ++next_resident_) {
    ++id;
  }
  if (id >= limits_->max_patches) return fail(MetaError::kIdOutOfRange);
  patch.id = PatchId{static_cast<std::uint32_t>(id)};
  next_id_ = static_cast<std::uint32_t>(id) + 1;
  return true;
}

/// The patches next in number, known before or new, below and above by turns.
template <class Coder>
void ShapeScript<Coder>::look_around(std::span<const NewResident> before) {
  const ResidentSet& residents = state_->residents;
  std::uint32_t above = next_resident_;
  std::uint32_t below = next_resident_;
  std::size_t left = before.size();
  near_ = {};
  for (std::uint32_t i = 0; i < near_.size(); ++i) {
    if (i % 2 == 1) {
      if (above == residents.size()) continue;
      near_[i] = {residents.shape(above), residents.block(above), true};
      ++above;
      continue;
    }
    const bool resident = below > 0;
    const bool fresh = left > 0;
    if (fresh && (!resident || before[left - 1].id > residents.id(below - 1))) {
      --left;
      near_[i] = {before[left].shape, before[left].block, true};
    } else if (resident) {
      --below;
      near_[i] = {residents.shape(below), residents.block(below), true};
    }
  }
  if (!near_[0].known) std::swap(near_[0], near_[1]);
}

template <class Coder>
bool ShapeScript<Coder>::code_class(const WantedPatch* wanted, PatchShape& shape) {
  const NearPatch& next = near_[0];
  const std::uint32_t triangles = models_->triangles[next.known ? next.shape.triangles : 0].code(
      *coder_, wanted ? wanted->triangles : 0U);
  const auto number_of = [](const PatchClass& draw) {
    return 2 * static_cast<std::uint32_t>(draw.alpha) + static_cast<std::uint32_t>(draw.double_sided);
  };
  const std::uint32_t draw = models_->draw[next.known ? number_of(next.shape.draw) : 6].code(
      *coder_, wanted ? number_of(wanted->draw) : 0U);
  if (triangles == 0 || draw > 5) return fail(MetaError::kBadPatch);
  shape.triangles = static_cast<std::uint8_t>(triangles);
  shape.draw.alpha = static_cast<PatchClass::Alpha>(draw / 2);
  shape.draw.double_sided = draw % 2 != 0;
  return true;
}

/// Whether the patch is attached to any of the open gates on offer, then which: one by one, until one is
/// taken.
template <class Coder>
typename ShapeScript<Coder>::Attached ShapeScript<Coder>::code_gate(std::span<const NewResident> before,
                                                                    const PatchShape& shape,
                                                                    const WantedPatch* wanted) {
  const GateOffers all(state_->gates, near_, before);
  GateOffer offer;
  const std::uint32_t fitting = wanted == nullptr ? GateTable::kNone : fitting_gate(all, *wanted);
  const bool attaches =
      coder_->code(models_->attached[gap_class_ * 8 + attached_flow_], fitting != GateTable::kNone);
  attached_flow_ = (attached_flow_ * 2 + static_cast<std::uint32_t>(attaches)) & 7U;
  if (!attaches) return {};
  for (GateOffers offers = all; offers.next(offer);) {
    const Gate& gate = state_->gates.gate(offer.gate);
    const std::uint32_t rank = offer.nearness * (Gate::kMostRefused + 1U) + gate.refused;
    AdaptiveBit& model =
        models_->gate[((rank * 5 + offer.edge) * 3 + offer.triangles - 1) * 3 + shape.triangles - 1];
    if (coder_->code(model, offer.gate == fitting)) return {&gate, offer.triangles, offer.edge};
    state_->gates.refuse(offer.gate);
  }
  return {};
}

/// The first gate on offer that an edge of the patch fills, or kNone.
template <class Coder>
std::uint32_t ShapeScript<Coder>::fitting_gate(GateOffers offers, const WantedPatch& wanted) const {
  const std::uint32_t corners = corner_count(wanted.triangles);
  std::array<std::uint32_t, kMaxPatchCorners> vertices{};
  for (std::uint32_t i = 0; i < corners; ++i) vertices[i] = state_->vertices.find(wanted.positions[i]);
  for (GateOffer offer; offers.next(offer);) {
    const Gate& gate = state_->gates.gate(offer.gate);
    for (std::uint32_t i = 0; i < corners; ++i) {
      if (vertices[i] == gate.from && vertices[(i + 1) % corners] == gate.to) return offer.gate;
    }
  }
  return GateTable::kNone;
}

template <class Coder>
bool ShapeScript<Coder>::code_corners(const Attached& attached, const WantedPatch* wanted,
                                      PatchShape& shape) {
  const std::uint32_t corners = corner_count(shape.triangles);
  const auto position_of = [&](std::uint32_t corner) {
    return wanted == nullptr ? nullptr : &wanted->positions[corner % corners];
  };
  std::array<std::uint32_t, kMaxPatchCorners> taken{};
  std::uint32_t count = 0;
  std::uint32_t turn = 0;
  if (attached.gate != nullptr) {
    const Gate& gate = *attached.gate;
    for (; wanted != nullptr && turn < corners; ++turn) {
      if (state_->vertices.find(*position_of(turn)) == gate.from &&
          state_->vertices.find(*position_of(turn + 1)) == gate.to) {
        break;
      }
    }
    turn = models_->turn[((shape.triangles - 1U) * 3 + attached.triangles - 1) * 5 + attached.edge].code(
        *coder_, turn);
    if (turn >= corners) return fail(MetaError::kBadPatch);
    taken[count++] = shape.corners[turn] = gate.from;
    taken[count++] = shape.corners[(turn + 1) % corners] = gate.to;
  }
  // Gates stay where they are: they change only when the patch is whole.
  const Gate* gate = attached.gate;
  for (std::uint32_t step = count; step < corners; ++step) {
    if (step == 2 && gate == nullptr) gate = gate_between(taken[0], taken[1]);
    const ExpectedCorner expected = expect(gate, shape, turn, step);
    const std::uint32_t vertex =
        corners_.code(expected, std::span(taken).first(count), position_of(turn + step));
    if (vertex == kNone) return fail(corners_.error());
    expected.ways.learn(at(vertex));
    expected.recall.learn(at(vertex));
    if (expected.corner) state_->shapes.learn(*expected.corner, at(vertex));
    taken[count++] = shape.corners[(turn + step) % corners] = vertex;
  }
  return true;
}

/// Where corner `turn + step` would be if the surface went on as it did.
template <class Coder>
ExpectedCorner ShapeScript<Coder>::expect(const Gate* gate, const PatchShape& shape, std::uint32_t turn,
                                          std::uint32_t step) {
  const std::uint32_t corners = corner_count(shape.triangles);
  ExpectedCorner expected;
  if (step > 0) expected.previous = shape.corners[(turn + step - 1) % corners];
  if (step == corners - 1) expected.following = shape.corners[turn];
  if (gate != nullptr) {
    expect_attached(*gate, shape, turn, step, expected);
  } else {
    expect_alone(shape, step, expected);
  }
  for (int axis = 0; axis < 3; ++axis) expected.at[axis] = std::clamp(expected.at[axis], 0, top());
  return expected;
}

template <class Coder>
void ShapeScript<Coder>::expect_attached(const Gate& gate, const PatchShape& shape, std::uint32_t turn,
                                         std::uint32_t step, ExpectedCorner& expected) {
  const std::uint32_t corners = corner_count(shape.triangles);
  const Offset from = at(gate.from);
  const Offset to = at(gate.to);
  const Offset behind_from = at(gate.behind_from);
  const Offset behind_to = at(gate.behind_to);
  const bool from_triangle = gate.behind_from == gate.behind_to;
  std::uint32_t stage = 0;
  if (step == 2) {
    const Offset onward = to - behind_to;
    const Offset beside = from - behind_from;
    if (!from_triangle) {
      expected.ways.positions = {to + onward, to + beside, to + (onward + beside) / 2};
    } else if (corners == 3) {
      expected.ways.positions = {to + beside, to + onward, from + beside};
    } else {
      expected.ways.positions = {to + (onward + beside) / 2, to + beside, to + onward};
    }
  } else {
    const Offset first = at(shape.corners[(turn + 2) % corners]);
    if (step == corners - 1) {
      stage = 2;
      const Offset bend = from_triangle ? Offset(0) : (from - to) - (behind_from - behind_to);
      const Offset own = from + (first - to);
      expected.ways.positions = {own, own + bend, own + bend / 2};
    } else {
      stage = 1;
      expected.ways.positions.fill(first + (from - to) / 2);
    }
  }
  const std::uint32_t situation = ((corners - 3) * 2 + static_cast<std::uint32_t>(from_triangle)) * 3 + stage;
  expected.ways.contest = &models_->ways[situation];
  expected.at = expected.ways.best();
  if (const auto frame = GateFrame::over(from, to, behind_from, behind_to)) {
    expect_remembered({*frame, situation}, expected);
  }
  expected.beside = {to, from};
  expected.scale =
      std::min<std::uint32_t>(17, static_cast<std::uint32_t>(std::bit_width(grid_distance(from, to))));
  expected.attached = true;
}

/// Where shapes told before have the corner, unless such memories were further off of late than the best way.
template <class Coder>
void ShapeScript<Coder>::expect_remembered(const GateCorner& corner, ExpectedCorner& expected) {
  expected.corner = corner;
  const GateFrame::Place* const place = state_->shapes.recall(corner);
  if (place == nullptr) return;
  expected.recall = {&models_->recalls[corner.situation],
                     {corner.frame.position(*place, top()), expected.at}};
  expected.remembered = expected.recall.contest->best() == 0;
  expected.at = expected.recall.best();
}

/// Where the nearest patch in number has its corner, moved as the corners before it moved.
template <class Coder>
void ShapeScript<Coder>::expect_alone(const PatchShape& shape, std::uint32_t step, ExpectedCorner& expected) {
  const std::uint32_t corners = corner_count(shape.triangles);
  const NearPatch& next = near_[0];
  const Outline other = outline_of(next.shape);
  expected.scale = step == 0 ? 18 : 19;
  if (step == 0) {
    if (!next.known) return;
    expected.at = at(other.at(0));
    expected.beside = {at(other.at(1)), at(other.at(2))};
    return;
  }
  const Offset before = at(shape.corners[step - 1]);
  expected.beside = {before, at(shape.corners[0])};
  if (step == 3 && corners == 4) {
    expected.at = at(shape.corners[0]) + before - at(shape.corners[1]);
  } else if (next.known) {
    expected.at = before + at(other.at(step)) - at(other.at(step - 1));
  } else {
    expected.at = before;
  }
}

}  // namespace atlaswire::codec
