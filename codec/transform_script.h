#pragma once

#include "codec/motion_state.h"
#include "codec/transform_grid.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace atlaswire::codec {

/// How a number goes on, in twentieths of its last five values, and how many of those it takes: a straight
/// line through two, none at all, parabolas through three and nearest to five, lines nearest to four and
/// five. The nearest ones average the grid's rounding noise out.
struct TransformPredictor {
  std::array<std::int32_t, ObjectTrack::kHistory> weights;
  std::uint8_t age;
};
inline constexpr std::int32_t kTransformParts = 20;
inline constexpr std::array<TransformPredictor, ObjectTrack::kPredictors> kTransformPredictors{
    {{{40, -20, 0, 0, 0}, 2},
     {{20, 0, 0, 0, 0}, 1},
     {{60, -60, 20, 0, 0}, 3},
     {{36, 0, -16, -12, 12}, 5},
     {{20, 10, 0, -10, 0}, 4},
     {{16, 10, 4, -2, -8}, 5}}};

/// Where a frame's rigid objects are, decision by decision, the same for both directions.
/// docs/PROTOCOL.md, "Objects". Each object's members are predicted by whichever predictor was least wrong
/// for it of late.
template <class Coder>
class TransformScript {
 public:
  TransformScript(Coder& coder, MotionState& state, const TransformGrid& grid)
      : coder_(&coder), state_(&state), models_(&state.models), grid_(&grid) {}

  enum class Fault : std::uint8_t { kNone, kTranslation, kRotation };
  /// `wanted`: one transform an object, only when encoding. A fault: nonsense was decoded.
  Fault code(std::span<const std::uint32_t> objects, std::span<const GridTransform> wanted);

 private:
  static constexpr std::size_t kGroup = 8;
  static constexpr std::uint8_t kCalm = 16;
  static constexpr std::uint32_t kLoudest = 255;
  using Faults = std::array<std::uint32_t, ObjectTrack::kPredictors>;
  using Past = std::array<std::int32_t, ObjectTrack::kHistory>;

  /// Numbers that are told one after another, and what is known before each.
  struct Group {
    DifferenceModels* models = nullptr;
    Faults* faults = nullptr;
    std::size_t predictor = 0;
    std::uint32_t nearby = 0;
    std::int32_t farthest = 0;  ///< numbers lie in -farthest..farthest
    std::uint32_t before = 0;
    std::uint32_t size = 0;  ///< of the differences so far, at most kLoudest
  };

  static Group begin(DifferenceModels& models, Faults& faults, std::uint32_t size, std::uint8_t age) {
    return {.models = &models,
            .faults = &faults,
            .predictor = best(faults, age),
            .nearby = age == 0 ? 15 : DifferenceModels::class_of(size)};
  }
  Fault code_object(ObjectTrack& track, const GridTransform* wanted);
  bool code_translation(ObjectTrack& track, const GridTransform* wanted, GridTransform& now);
  bool code_rotation(ObjectTrack& track, const GridTransform* wanted, GridTransform& now);
  bool code_number(Group& group, const Past& past, std::int32_t wanted, std::int32_t& now);
  static std::size_t best(const Faults& faults, std::uint8_t age);
  static std::int64_t predict(const Past& past, std::size_t predictor);
  static void judge(Faults& faults, const Past& past, std::int32_t came);
  static void push(ObjectTrack& track, const GridTransform& now);
  static void rest(ObjectTrack& track) {
    push(track, track.at[0]);
    if (track.calm < 255) ++track.calm;
  }

  Coder* coder_;
  MotionState* state_;
  MotionModels* models_;
  const TransformGrid* grid_;
  std::uint32_t flow_ = 0;  ///< of the objects before: 2 the last moved, 1 the one before it
};

template <class Coder>
typename TransformScript<Coder>::Fault TransformScript<Coder>::code(std::span<const std::uint32_t> objects,
                                                                    std::span<const GridTransform> wanted) {
  std::uint32_t group_flow = 0;
  for (std::size_t first = 0; first < objects.size(); first += kGroup) {
    const std::size_t end = std::min(objects.size(), first + kGroup);
    bool calm = true;
    bool moves = false;
    for (std::size_t i = first; i < end; ++i) {
      const ObjectTrack& track = state_->objects[objects[i]];
      calm = calm && track.calm >= kCalm;
      moves = moves || (!wanted.empty() && wanted[i] != track.at[0]);
      state_->mix(objects[i]);
    }
    if (calm) {
      moves = coder_->code(models_->calm_object_group[group_flow], moves);
      group_flow = moves ? 2 : group_flow == 2 ? 1 : 0;
      if (!moves) {
        for (std::size_t i = first; i < end; ++i) rest(state_->objects[objects[i]]);
        continue;
      }
    }
    for (std::size_t i = first; i < end; ++i) {
      const Fault fault = code_object(state_->objects[objects[i]], wanted.empty() ? nullptr : &wanted[i]);
      if (fault != Fault::kNone) return fault;
    }
  }
  return Fault::kNone;
}

template <class Coder>
typename TransformScript<Coder>::Fault TransformScript<Coder>::code_object(ObjectTrack& track,
                                                                           const GridTransform* wanted) {
  const std::uint32_t calm = track.calm == 0 ? 0 : 1;
  const bool rests =
      coder_->code(models_->rests[calm * 3 + flow_], wanted != nullptr && *wanted == track.at[0]);
  flow_ = !rests ? 2 : flow_ == 2 ? 1 : 0;
  if (rests) {
    rest(track);
    return Fault::kNone;
  }
  GridTransform now;
  if (!code_translation(track, wanted, now)) return Fault::kTranslation;
  if (!code_rotation(track, wanted, now)) return Fault::kRotation;
  track.calm = 0;
  push(track, now);
  state_->mix(now.translation);
  state_->mix(now.largest);
  for (const std::int32_t member : now.rotation) state_->mix(static_cast<std::uint32_t>(member));
  return Fault::kNone;
}

template <class Coder>
bool TransformScript<Coder>::code_translation(ObjectTrack& track, const GridTransform* wanted,
                                              GridTransform& now) {
  Group group = begin(models_->translation, track.translation_faults, track.translation_size, track.age);
  group.farthest = TransformGrid::kFarthest;
  for (int axis = 0; axis < 3; ++axis) {
    Past past{};
    for (std::size_t back = 0; back < past.size(); ++back) past[back] = track.at[back].translation[axis];
    if (!code_number(group, past, wanted == nullptr ? 0 : wanted->translation[axis], now.translation[axis]))
      return false;
  }
  track.translation_size = static_cast<std::uint16_t>(std::min(kLoudest, group.size));
  return true;
}

/// Past orientations take the sign that lets the largest member be as it is told: q and -q are one.
template <class Coder>
bool TransformScript<Coder>::code_rotation(ObjectTrack& track, const GridTransform* wanted,
                                           GridTransform& now) {
  Group group = begin(models_->rotation, track.rotation_faults, track.rotation_size, track.age);
  group.farthest = 1 << grid_->rotation_bits;
  now.largest = models_->largest[track.at[0].largest].code(*coder_, wanted == nullptr ? 0 : wanted->largest);
  std::array<std::int32_t, ObjectTrack::kHistory> signs{};
  signs[0] = track.at[0].rotation[now.largest] < 0 ? -1 : 1;
  for (std::size_t back = 1; back < signs.size(); ++back) {
    std::int64_t along = 0;
    for (std::size_t i = 0; i < 4; ++i)
      along += std::int64_t{track.at[back].rotation[i]} * track.at[back - 1].rotation[i];
    signs[back] = along < 0 ? -signs[back - 1] : signs[back - 1];
  }
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (i == now.largest) continue;
    Past past{};
    for (std::size_t back = 0; back < signs.size(); ++back)
      past[back] = signs[back] * track.at[back].rotation[i];
    if (!code_number(group, past, wanted == nullptr ? 0 : wanted->rotation[i], now.rotation[i])) return false;
  }
  track.rotation_size = static_cast<std::uint16_t>(std::min(kLoudest, group.size));
  return grid_->complete(now);
}

/// False: it is beyond the group's range.
template <class Coder>
bool TransformScript<Coder>::code_number(Group& group, const Past& past, std::int32_t wanted,
                                         std::int32_t& now) {
  Rounded expected = Rounded::of(predict(past, group.predictor), kTransformParts);
  expected.clamp(-group.farthest, group.farthest);
  const auto at = static_cast<std::int32_t>(expected.at);
  const std::int32_t difference =
      group.models->code(*coder_, group.nearby, group.before, expected.left, kTransformParts, wanted - at);
  group.before = std::max(group.before, difference != 0 ? 2U : 1U);
  const std::int64_t sum = std::int64_t{at} + difference;
  if (sum < -group.farthest || sum > group.farthest) return false;
  now = static_cast<std::int32_t>(sum);
  group.size = std::min(kLoudest, group.size + static_cast<std::uint32_t>(std::abs(difference)));
  judge(*group.faults, past, now);
  return true;
}

/// The least wrong of those that the past is long enough for; the first of equals.
template <class Coder>
std::size_t TransformScript<Coder>::best(const Faults& faults, std::uint8_t age) {
  std::size_t found = 1;
  for (std::size_t p = 0; p < faults.size(); ++p) {
    if (kTransformPredictors[p].age > age) continue;
    if (kTransformPredictors[found].age > age || faults[p] < faults[found] ||
        (faults[p] == faults[found] && p < found))
      found = p;
  }
  return found;
}

template <class Coder>
std::int64_t TransformScript<Coder>::predict(const Past& past, std::size_t predictor) {
  std::int64_t parts = 0;
  for (std::size_t back = 0; back < past.size(); ++back)
    parts += std::int64_t{kTransformPredictors[predictor].weights[back]} * past[back];
  return parts;
}

/// Faults in parts of a step, at most 2^16 at once; an eighth is forgotten each time.
template <class Coder>
void TransformScript<Coder>::judge(Faults& faults, const Past& past, std::int32_t came) {
  for (std::size_t p = 0; p < faults.size(); ++p) {
    const std::int64_t fault = std::abs(predict(past, p) - std::int64_t{kTransformParts} * came);
    faults[p] += static_cast<std::uint32_t>(std::min<std::int64_t>(fault, 1 << 16)) - faults[p] / 8;
  }
}

template <class Coder>
void TransformScript<Coder>::push(ObjectTrack& track, const GridTransform& now) {
  for (std::size_t i = track.at.size() - 1; i > 0; --i) track.at[i] = track.at[i - 1];
  track.at[0] = now;
  if (track.age < ObjectTrack::kHistory) ++track.age;
}

}  // namespace atlaswire::codec
