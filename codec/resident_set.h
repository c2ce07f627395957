#pragma once

#include "base/block.h"
#include "base/ids.h"
#include "base/patch_layout.h"
#include "codec/octet_group.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::codec {

/// What never changes of a patch.
struct PatchShape {
  std::uint8_t triangles = 1;  ///< 1..3
  PatchClass draw;
  std::array<std::uint32_t, kMaxPatchCorners>
      corners{};  ///< vertices; the first corner_count(triangles) count

  auto operator<=>(const PatchShape&) const = default;
};

/// A patch that becomes known.
struct NewResident {
  PatchId id{};
  PatchShape shape;
  Block block;
};

/// The patches that both ends know, visible or not, ascending by id. A hidden one keeps its last block.
class ResidentSet {
 public:
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(ids_.size()); }
  [[nodiscard]] std::uint32_t visible() const { return visible_; }
  [[nodiscard]] PatchId id(std::uint32_t index) const { return ids_[index]; }
  /// Visible in each of the last 8 updates, the newest in bit 0.
  [[nodiscard]] std::uint8_t history(std::uint32_t index) const { return histories_[index]; }
  [[nodiscard]] bool visible(std::uint32_t index) const { return (histories_[index] & 1U) != 0; }
  /// Updates since it last came or went; stays at 255.
  [[nodiscard]] std::uint8_t calm(std::uint32_t index) const { return calms_[index]; }
  [[nodiscard]] const PatchShape& shape(std::uint32_t index) const { return shapes_[index]; }
  [[nodiscard]] Block& block(std::uint32_t index) { return blocks_[index]; }
  [[nodiscard]] const Block& block(std::uint32_t index) const { return blocks_[index]; }
  /// Index of the first patch whose id is not below `id`.
  [[nodiscard]] std::uint32_t lower_bound(PatchId id) const;

  // Of a group: `count` patches from `first` on, at most kGroup; a bit each, the first's lowest.
  static constexpr std::uint32_t kGroup = OctetGroup::kSize;
  [[nodiscard]] std::uint32_t visible_in(std::uint32_t first, std::uint32_t count) const;
  /// How calm all of them are: 0: below 8, 1: from 8 on, 2: from 16, 3: from 32.
  [[nodiscard]] std::uint32_t calm_in(std::uint32_t first, std::uint32_t count) const;
  /// Notes which come or go in this update.
  void note(std::uint32_t first, std::uint32_t count, std::uint32_t flips);
  /// Takes in patches, visible now; ascending, none known before.
  void merge(std::span<const NewResident> arrivals);
  /// Forgets the patches marked; one mark each.
  void drop(const std::vector<bool>& marks);
  void clear();

 private:
  /// Does the same to each list.
  template <class Do>
  void for_each_list(Do action);

  /// In all the same order.
  std::vector<PatchId> ids_;
  std::vector<std::uint8_t> histories_;
  std::vector<std::uint8_t> calms_;
  std::vector<PatchShape> shapes_;
  std::vector<Block> blocks_;
  std::uint32_t visible_ = 0;
};

inline std::uint32_t ResidentSet::visible_in(std::uint32_t first, std::uint32_t count) const {
  if (count == kGroup) return OctetGroup::load(&histories_[first]).lowest_bits();
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < count; ++i) bits |= static_cast<std::uint32_t>(visible(first + i)) << i;
  return bits;
}

inline std::uint32_t ResidentSet::calm_in(std::uint32_t first, std::uint32_t count) const {
  if (count == kGroup) return OctetGroup::load(&calms_[first]).all_from_8_16_32();
  const auto begin = calms_.begin() + first;
  const std::uint32_t least = *std::min_element(begin, begin + count);
  return least < 8 ? 0 : least < 16 ? 1 : least < 32 ? 2 : 3;
}

inline void ResidentSet::note(std::uint32_t first, std::uint32_t count, std::uint32_t flips) {
  if (count == kGroup) {
    OctetGroup::load(&histories_[first]).repeated().store(&histories_[first]);
    OctetGroup::load(&calms_[first]).counted().store(&calms_[first]);
  } else {
    for (std::uint32_t i = first; i < first + count; ++i) {
      const std::uint32_t history = histories_[i];
      histories_[i] = static_cast<std::uint8_t>(history << 1U | (history & 1U));
      if (calms_[i] != 255) ++calms_[i];
    }
  }
  for (; flips != 0; flips &= flips - 1) {
    const std::uint32_t i = first + static_cast<std::uint32_t>(std::countr_zero(flips));
    histories_[i] ^= 1U;
    calms_[i] = 0;
    visible(i) ? ++visible_ : --visible_;
  }
}

}  // namespace atlaswire::codec
