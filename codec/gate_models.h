#pragma once

#include "codec/adaptive_models.h"
#include "codec/forecast.h"
#include "codec/resident_outlook.h"

#include <array>
#include <cstdint>

namespace atlaswire::codec {

/// Contexts of a whole number that is about 0: whether it is, which side it lies on, and how far.
struct OffsetModels {
  AdaptiveBit off;
  AdaptiveBit below;
  AdaptiveBit far;
  AdaptiveTree<5> further;  ///< distance - 2
};

/// Contexts of a block's size, apart for blocks that change, come back and are new.
struct LevelModels {
  std::array<OffsetModels, 16> area;            ///< by the reference's
  std::array<OffsetModels, 3 * 7 * 4> stretch;  ///< by how the area went, the reference's stretch and area
  std::array<AdaptiveBit, 2> mirrored_square;   ///< by whether the reference is mirrored
};

/// Contexts of where a vertex is, relative to where it was expected.
struct PositionModels {
  static constexpr std::uint32_t kScales = 20;
  /// Equal to one of three coordinates nearby: by which, scale, how many of the axes before were, and axis.
  std::array<AdaptiveBit, 3 * kScales * 3 * 3> equals;
  std::array<AdaptiveTree<5>, kScales * 3> length;  ///< bit length: by scale, and the axis before
  std::array<std::array<AdaptiveBit, 4>, 32> mantissa;
};

/// Every adaptive context of the gate form, as long-lived as the stream between two restarts.
struct GateModels {
  static constexpr std::uint32_t kNear = 6;              ///< patches near in number, whose gates are offered
  static constexpr std::uint32_t kDistanceClasses = 10;  ///< of a corner on offer from where one was expected

  // The head of an update.
  AdaptiveBit next_frame;
  AdaptiveBit any_drops;
  AdaptiveBit more_drops;
  AdaptiveUnsigned drop_skip;
  AdaptiveUnsigned drop_length;

  AdaptiveBit memory_reset;  ///< only where positions are derived

  // Who comes and goes.
  /// By whether the calm groups before stayed calm, how calm, how many are visible (none, some, all), and the
  /// patch before.
  std::array<AdaptiveBit, 3 * 3 * 3 * 4> calm_group;
  /// By outlook, and the patch before: visible, and twice whether it came or went.
  std::array<AdaptiveBit, ResidentOutlook::kCount * 4> flip;
  std::array<AdaptiveBit, 3> change_group;
  /// By calm, the patches before in the group, whether any of those changes, and how many are left.
  std::array<AdaptiveBit, 3 * 3 * 2 * 8> change;
  LevelModels changed_level;
  LevelModels shown_level;
  LevelModels new_level;

  // Patches never seen before.
  AdaptiveUnsigned new_patches;
  std::array<AdaptiveUnsigned, 3> gap;       ///< by the gap before
  std::array<AdaptiveTree<2>, 4> triangles;  ///< by those of the nearest patch
  std::array<AdaptiveTree<3>, 7> draw;       ///< by that of the nearest patch
  std::array<AdaptiveBit, 3 * 8>
      attached;  ///< by how far off in number the patch before is, and whether the three before were
  std::array<AdaptiveBit, (kNear + 1) * 4 * 5 * 3 * 3>
      gate;  ///< by nearness, how often refused, edge, its patch's triangles, own triangles
  std::array<AdaptiveTree<3>, 3 * 3 * 5> turn;  ///< by own triangles, those of the gate's patch, its edge
  std::array<AdaptiveBit, 3 * kDistanceClasses * 3 * 2> corner;
  std::array<PositionModels, 3> position;  ///< alone, with a gate, remembered
  /// Ways to foretell an attached corner from its gate; and the best of them against shapes remembered. By
  /// own triangles, whether the gate's patch is one triangle, and which corner.
  std::array<Contest<3, 64>, 3 * 2 * 3> ways;
  std::array<Contest<2, 16>, 3 * 2 * 3> recalls;

  // Where blocks are.
  AdaptiveBit aligned;
  std::array<AdaptiveTree<4>, 16> block_x;  ///< by width
  std::array<AdaptiveTree<4>, 16> block_y;  ///< by height
};

}  // namespace atlaswire::codec
