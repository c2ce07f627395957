#pragma once

#include "codec/adaptive_models.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>

namespace atlaswire::codec {

/// A prediction in fractions of a step, rounded: the nearest whole step and what is left, -size/2..size/2 - 1
/// of `size` parts.
struct Rounded {
  std::int64_t at = 0;
  std::int32_t left = 0;

  static Rounded of(std::int64_t parts, std::int32_t size) {
    const std::int64_t raised = parts + size / 2;
    const std::int64_t at = raised / size - (raised % size < 0 ? 1 : 0);
    return {at, static_cast<std::int32_t>(parts - at * size)};
  }
  /// Not outside low..high; nothing is left where it would have been.
  void clamp(std::int64_t low, std::int64_t high) {
    if (at >= low && at <= high) return;
    at = std::clamp(at, low, high);
    left = 0;
  }
};

/// Differences between what is and what was predicted. docs/PROTOCOL.md, "Differences".
class DifferenceModels {
 public:
  static constexpr std::uint32_t kClasses = 18;
  /// Classes 0 to 14 by how large differences were nearby (in steps); the rest are for who has no past.
  static std::uint32_t class_of(std::uint32_t size) {
    return size < 8 ? size : std::min(14U, 4 + static_cast<std::uint32_t>(std::bit_width(size)));
  }

  /// A difference from a prediction of which `left` of `size` parts were cut off. `before`: 0, or what the
  /// axes before had: 1 nothing, 2 something. With a decoder `value` is ignored. Below 2^31 in size.
  template <class Coder>
  std::int32_t code(Coder& coder, std::uint32_t nearby, std::uint32_t before, std::int32_t left,
                    std::int32_t size, std::int32_t value) {
    const std::int32_t ten = 10 * std::abs(left);
    const std::uint32_t cut = ten <= size ? 0 : ten <= 3 * size ? 1 : 2;
    const auto wanted = static_cast<std::uint32_t>(std::abs(value));
    const auto wanted_length = static_cast<std::uint32_t>(std::bit_width(wanted));
    if (!coder.code(differs_[(nearby * 3 + cut) * 3 + before], wanted != 0)) return 0;
    const bool against = coder.code(against_[(loudness(nearby) * 3) + cut], (value < 0) != (left < 0));
    std::uint32_t length = 1;
    while (length < kLongest && coder.code(longer_[nearby * kLongest + length], length < wanted_length))
      ++length;
    const auto magnitude = static_cast<std::int32_t>(
        AdaptiveUnsigned::code_below_leading(coder, mantissa_[length], length, wanted));
    return against != (left < 0) ? -magnitude : magnitude;
  }

 private:
  static constexpr std::uint32_t kLongest = 31;
  static std::uint32_t loudness(std::uint32_t nearby) { return nearby < 4 ? 0 : nearby < 9 ? 1 : 2; }

  std::array<AdaptiveBit, kClasses * 3 * 3> differs_;
  std::array<AdaptiveBit, 3 * 3> against_;  ///< against the part that was cut off
  std::array<AdaptiveBit, kClasses * kLongest> longer_;
  std::array<std::array<AdaptiveBit, 4>, 32> mantissa_;
};

/// What the next velocity of a vertex is made of, in 1024ths: its neighbours' velocity now, its own last
/// three, and its neighbours' last three.
struct MotionWeights {
  static constexpr std::uint32_t kCount = 7;
  /// Fine enough for vertices that go hundreds of steps a frame.
  static constexpr std::int32_t kOne = 1024;
  static constexpr std::int32_t kMost = 8 * kOne - 1;
  /// Second order in time, minus the neighbours' difference.
  std::array<std::int32_t, kCount> of{kOne, kOne, 0, 0, -kOne, 0, 0};

  bool operator==(const MotionWeights&) const = default;
};

/// Every adaptive context of a motion stream, as long-lived as the stream between two restarts.
struct MotionModels {
  static constexpr std::uint32_t kWeightSets = 3;  ///< by how large a vertex's last difference was
  static std::uint32_t weight_set_of(std::uint32_t size) { return size < 4 ? 0 : size < 13 ? 1 : 2; }

  // Weights.
  AdaptiveBit any_weights;
  std::array<AdaptiveBit, kWeightSets> changes_weights;
  AdaptiveUnsigned weight_change;

  // Vertices.
  std::array<AdaptiveBit, 3> calm_group;  ///< by whether the calm groups before stayed calm
  std::array<AdaptiveBit, 3> calm;        ///< by whether the neighbours move
  DifferenceModels position;

  // Objects.
  std::array<AdaptiveBit, 3> calm_object_group;
  std::array<AdaptiveBit, 2 * 3> rests;  ///< by whether it did, and the objects before
  DifferenceModels translation;
  std::array<AdaptiveTree<2>, 4> largest;  ///< by what it was
  DifferenceModels rotation;
};

}  // namespace atlaswire::codec
