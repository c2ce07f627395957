#pragma once

#include "base/assert.h"
#include "codec/motion.h"
#include "codec/transform_script.h"
#include "codec/vertex_motion_script.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace atlaswire::codec {

/// A frame's motion on the grid, one entry for each in the scope.
struct MotionWanted {
  std::span<const glm::ivec3> positions;
  std::span<const GridTransform> transforms;
};

/// One motion message, decision by decision, the same for both directions. Either way the state moves on.
/// docs/PROTOCOL.md, "Motion".
template <class Coder>
class MotionScript {
 public:
  /// `wanted` and `fit`, only when encoding; without a fit weights stay as they are.
  MotionScript(Coder& coder, MotionState& state, const MotionSettings& settings, const MotionScope& scope,
               const MotionWanted* wanted, MotionFit* fit)
      : coder_(&coder), state_(&state), settings_(&settings), scope_(scope), wanted_(wanted), fit_(fit) {}

  /// An error only if decoding: the state is nonsense then.
  std::optional<MotionError> code();

 private:
  void gather();
  template <class Leave>
  static void for_those_who_left(std::vector<std::uint32_t>& before, std::span<const std::uint32_t> now,
                                 const Leave& leave);
  bool code_weights();
  bool code_hash();

  Coder* coder_;
  MotionState* state_;
  const MotionSettings* settings_;
  MotionScope scope_;
  const MotionWanted* wanted_;
  MotionFit* fit_;
};

template <class Coder>
std::optional<MotionError> MotionScript<Coder>::code() {
  gather();
  if (!code_weights()) return MotionError::kBadWeights;
  using Transforms = TransformScript<Coder>;
  const auto fault =
      Transforms(*coder_, *state_, settings_->transforms)
          .code(scope_.objects, wanted_ == nullptr ? std::span<const GridTransform>{} : wanted_->transforms);
  if (fault == Transforms::Fault::kTranslation) return MotionError::kBadTranslation;
  if (fault == Transforms::Fault::kRotation) return MotionError::kBadRotation;
  if (!scope_.vertices.empty()) {
    VertexMotionScript<Coder> vertices(*coder_, *state_, *scope_.surface, settings_->grid.bits, fit_);
    if (!vertices.code(scope_.vertices,
                       wanted_ == nullptr ? std::span<const glm::ivec3>{} : wanted_->positions)) {
      return MotionError::kBadPosition;
    }
  }
  if (!code_hash()) return MotionError::kOutOfStep;
  return std::nullopt;
}

/// Makes tracks for who is new, and ends the age of who left.
template <class Coder>
void MotionScript<Coder>::gather() {
  const auto ascends = [](std::span<const std::uint32_t> list) {
    return std::ranges::adjacent_find(list, [](auto a, auto b) { return a >= b; }) == list.end();
  };
  AW_ASSERT(ascends(scope_.vertices) && ascends(scope_.objects));
  auto& objects = state_->objects;
  if (!scope_.objects.empty() && scope_.objects.back() >= objects.size()) {
    AW_ASSERT(scope_.objects.back() < MotionScope::kMostObjects);
    ObjectTrack fresh;
    fresh.at.fill(settings_->transforms.rest());
    objects.resize(scope_.objects.back() + 1, fresh);
  }
  auto& vertices = state_->vertices;
  if (scope_.surface != nullptr) {
    AW_ASSERT(scope_.vertices.empty() || scope_.vertices.back() < scope_.surface->size());
    for (auto v = static_cast<std::uint32_t>(vertices.size()); v < scope_.surface->size(); ++v)
      vertices.emplace_back().at.fill(glm::ivec3(scope_.surface->rest(v)));
  }
  for_those_who_left(state_->moving, scope_.vertices, [&](std::uint32_t v) {
    vertices[v].age = 0;
    vertices[v].jumped = false;
  });
  for_those_who_left(state_->moving_objects, scope_.objects, [&](std::uint32_t o) {
    objects[o].age = 0;
    objects[o].calm = 0;
  });
  state_->mix(static_cast<std::uint32_t>(scope_.vertices.size()));
  state_->mix(static_cast<std::uint32_t>(scope_.objects.size()));
}

/// Calls `leave` for each of `before` that is not in `now`, then makes `before` what `now` is.
template <class Coder>
template <class Leave>
void MotionScript<Coder>::for_those_who_left(std::vector<std::uint32_t>& before,
                                             std::span<const std::uint32_t> now, const Leave& leave) {
  auto there = now.begin();
  for (const std::uint32_t number : before) {
    while (there != now.end() && *there < number) ++there;
    if (there == now.end() || *there != number) leave(number);
  }
  before.assign(now.begin(), now.end());
}

/// Which the encoder has found to predict best.
template <class Coder>
bool MotionScript<Coder>::code_weights() {
  if (scope_.vertices.empty()) return true;
  MotionModels& models = state_->models;
  auto wanted = state_->weights;
  if (fit_ != nullptr) {
    for (std::uint32_t set = 0; set < wanted.size(); ++set) wanted[set] = fit_->renew(set, wanted[set]);
  }
  if (!coder_->code(models.any_weights, wanted != state_->weights)) return true;
  for (std::uint32_t set = 0; set < wanted.size(); ++set) {
    MotionWeights& now = state_->weights[set];
    if (!coder_->code(models.changes_weights[set], wanted[set] != now)) continue;
    for (std::uint32_t i = 0; i < MotionWeights::kCount; ++i) {
      const std::int32_t change = wanted[set].of[i] - now.of[i];
      const std::uint32_t zigzag = models.weight_change.code(
          *coder_, static_cast<std::uint32_t>(change < 0 ? -2 * change - 1 : 2 * change));
      if (zigzag > 4 * static_cast<std::uint32_t>(MotionWeights::kMost)) return false;
      const auto half = static_cast<std::int32_t>(zigzag / 2);
      now.of[i] += zigzag % 2 == 1 ? -half - 1 : half;
      if (now.of[i] < -MotionWeights::kMost || now.of[i] > MotionWeights::kMost) return false;
      state_->mix(static_cast<std::uint32_t>(now.of[i]));
    }
  }
  return true;
}

/// Tells a decoder that it knows what the encoder knows.
template <class Coder>
bool MotionScript<Coder>::code_hash() {
  const std::uint32_t own = state_->hash >> 16U;
  return coder_->code_raw(own, 16) == own;
}

}  // namespace atlaswire::codec
