#pragma once

#include "codec/block_script.h"
#include "codec/gate_plan.h"
#include "codec/gate_state.h"
#include "codec/presence_script.h"
#include "codec/shape_script.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace atlaswire::codec {

/// One update of the gate form, decision by decision, the same for both directions: with a RangeEncoder it
/// follows a plan, with a RangeDecoder it finds out. Either way the state moves on. docs/PROTOCOL.md, "Meta
/// update, gate form".
template <class Coder>
class GateScript {
 public:
  /// `most_new`: patches that may come new. `cue`: coded instead of where blocks lie; null: positions are.
  /// `plan`, only when encoding.
  GateScript(Coder& coder, GateState& state, const MetaLimits& limits, std::uint32_t most_new, LayoutCue* cue,
             GatePlan* plan)
      : coder_(&coder), state_(&state), limits_(&limits), most_new_(most_new), cue_(cue), plan_(plan) {}

  /// The update's effect, as a MetaUpdate if decoding; an error only if decoding: the state is nonsense then.
  std::optional<MetaError> code(bool first, MetaUpdate* effect);

 private:
  void code_frame(bool first);
  void code_cue();
  bool code_drops();
  void drop();
  bool code_presence();
  bool code_shapes();
  bool code_blocks();
  bool code_hash();
  void report(MetaUpdate& effect, std::uint32_t first_vertex);
  bool fail(MetaError why) {
    error_ = why;
    return false;
  }

  Coder* coder_;
  GateState* state_;
  const MetaLimits* limits_;
  std::uint32_t most_new_;
  LayoutCue* cue_;
  GatePlan* plan_;
  std::vector<bool> drops_;
  std::vector<PatchId> removed_;
  std::vector<std::uint32_t> hidden_;
  std::vector<Placement> placements_;
  std::span<const Block* const> targets_;
  std::vector<NewResident> arrivals_;
  std::optional<MetaError> error_;
};

template <class Coder>
std::optional<MetaError> GateScript<Coder>::code(bool first, MetaUpdate* effect) {
  const std::uint32_t first_vertex = state_->vertices.size();
  code_frame(first);
  if (cue_ != nullptr) code_cue();
  if (!(code_drops() && code_presence() && code_shapes() && code_blocks())) return error_;
  if (effect != nullptr) report(*effect, first_vertex);
  for (const Placement& p : placements_) state_->residents.block(p.resident) = p.block;
  state_->residents.merge(arrivals_);
  if (!code_hash()) return error_;
  return std::nullopt;
}

template <class Coder>
void GateScript<Coder>::code_frame(bool first) {
  const FrameId wanted = plan_ == nullptr ? FrameId{} : plan_->frame();
  const FrameId expected = next(state_->frame);
  if (!first && coder_->code(state_->models.next_frame, wanted == expected)) {
    state_->frame = expected;
  } else {
    state_->frame = FrameId{coder_->code_raw(value(wanted), 32)};
  }
  state_->mix(value(state_->frame));
}

template <class Coder>
void GateScript<Coder>::code_cue() {
  cue_->reset = coder_->code(state_->models.memory_reset, cue_->reset);
  cue_->check = static_cast<std::uint16_t>(coder_->code_raw(cue_->check, 16));
  state_->mix(std::uint32_t{cue_->check} << 1U | static_cast<std::uint32_t>(cue_->reset));
}

/// Runs of forgotten patches over all that are known.
template <class Coder>
bool GateScript<Coder>::code_drops() {
  GateModels& models = state_->models;
  const std::uint32_t size = state_->residents.size();
  if (plan_ != nullptr) drops_ = plan_->drops();
  drops_.resize(size);
  std::uint32_t at = 0;
  bool any = false;
  const auto length_of_run = [&](std::uint32_t from, bool dropped) {
    std::uint32_t end = from;
    while (end < size && drops_[end] == dropped) ++end;
    return end - from;
  };
  for (;;) {
    std::uint32_t kept = plan_ == nullptr ? 0 : length_of_run(at, false);
    if (!coder_->code(any ? models.more_drops : models.any_drops, at + kept < size)) break;
    kept = models.drop_skip.code(*coder_, kept);
    if (kept >= size - at) return fail(MetaError::kIdOutOfRange);
    at += kept;
    std::uint32_t dropped = plan_ == nullptr ? 0 : length_of_run(at, true) - 1;
    dropped = models.drop_length.code(*coder_, dropped);
    if (dropped >= size - at) return fail(MetaError::kIdOutOfRange);
    for (std::uint32_t end = at + dropped + 1; at < end; ++at) drops_[at] = true;
    any = true;
  }
  if (any) drop();
  return true;
}

template <class Coder>
void GateScript<Coder>::drop() {
  ResidentSet& residents = state_->residents;
  for (std::uint32_t i = 0; i < residents.size(); ++i) {
    if (!drops_[i]) continue;
    state_->mix(value(residents.id(i)));
    if (residents.visible(i)) removed_.push_back(residents.id(i));
  }
  residents.drop(drops_);
  state_->gates.clear();
  for (std::uint32_t i = 0; i < residents.size(); ++i) {
    const PatchShape& shape = residents.shape(i);
    state_->gates.add({shape.corners, corner_count(shape.triangles)});
  }
}

template <class Coder>
bool GateScript<Coder>::code_presence() {
  if (plan_ != nullptr) targets_ = plan_->targets(state_->residents);
  if (!PresenceScript<Coder>(*coder_, *state_, targets_).code(hidden_, placements_)) {
    return fail(MetaError::kBadBlock);
  }
  for (const std::uint32_t i : hidden_) state_->mix(i);
  return true;
}

template <class Coder>
bool GateScript<Coder>::code_shapes() {
  const std::span<const WantedPatch> wanted =
      plan_ == nullptr ? std::span<const WantedPatch>{} : plan_->arrivals();
  const std::uint32_t count =
      state_->models.new_patches.code(*coder_, static_cast<std::uint32_t>(wanted.size()));
  if (count > most_new_) return fail(MetaError::kTooLarge);
  ShapeScript<Coder> shapes(*coder_, *state_, *limits_);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto arrival = shapes.code(arrivals_, wanted.empty() ? nullptr : &wanted[i]);
    if (!arrival) return fail(shapes.error());
    arrivals_.push_back(*arrival);
  }
  return true;
}

template <class Coder>
bool GateScript<Coder>::code_blocks() {
  const auto code_position = [&](const Block* wanted, Block& block) {
    if (wanted != nullptr) {
      block.x = wanted->x;
      block.y = wanted->y;
    }
    if (cue_ == nullptr && !code_block_position(*coder_, state_->models, limits_->atlas, block)) {
      return fail(MetaError::kBadBlock);
    }
    state_->mix(block);
    return true;
  };
  for (Placement& p : placements_) {
    state_->mix(p.resident);
    if (!code_position(targets_.empty() ? nullptr : targets_[p.resident], p.block)) return false;
  }
  for (std::size_t i = 0; i < arrivals_.size(); ++i) {
    if (!code_position(plan_ == nullptr ? nullptr : &plan_->arrivals()[i].block, arrivals_[i].block))
      return false;
  }
  return true;
}

/// Tells a decoder that it knows what the encoder knows.
template <class Coder>
bool GateScript<Coder>::code_hash() {
  const std::uint32_t own = state_->hash.upper();
  return coder_->code_raw(own, 16) == own || fail(MetaError::kOutOfStep);
}

template <class Coder>
void GateScript<Coder>::report(MetaUpdate& effect, std::uint32_t first_vertex) {
  const ResidentSet& residents = state_->residents;
  effect.frame = state_->frame;
  effect.removed = removed_;
  for (const std::uint32_t i : hidden_) effect.removed.push_back(residents.id(i));
  if (!removed_.empty()) std::ranges::sort(effect.removed);
  effect.vertices.reserve(state_->vertices.size() - first_vertex);
  for (std::uint32_t v = first_vertex; v < state_->vertices.size(); ++v) {
    effect.vertices.push_back({VertexId{v}, state_->vertices.position(v)});
  }
  effect.added.reserve(placements_.size() + arrivals_.size());
  const auto add = [&](PatchId id, const PatchShape& shape, const Block& block) {
    AddedPatch added{.id = id, .triangles = shape.triangles, .draw = shape.draw, .block = block};
    std::ranges::transform(shape.corners, added.corners.begin(), [](std::uint32_t v) { return VertexId{v}; });
    effect.added.push_back(added);
  };
  auto arrival = arrivals_.begin();
  const auto add_arrivals_below = [&](PatchId id) {
    for (; arrival != arrivals_.end() && arrival->id < id; ++arrival)
      add(arrival->id, arrival->shape, arrival->block);
  };
  for (const Placement& p : placements_) {
    const PatchId id = residents.id(p.resident);
    if (p.why == Placement::Why::kChanged) {
      effect.moved.push_back({id, p.block});
    } else {
      add_arrivals_below(id);
      add(id, residents.shape(p.resident), p.block);
    }
  }
  add_arrivals_below(PatchId{~0U});
}

}  // namespace atlaswire::codec
