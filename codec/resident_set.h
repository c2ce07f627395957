#pragma once

#include "base/block.h"
#include "base/ids.h"
#include "base/patch_layout.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::codec {

/// How a patch has come and gone: what foretells whether it comes or goes now.
struct Presence {
  PatchId id{};
  bool visible = false;
  std::uint8_t history = 0;  ///< visible in each of the last 8 updates, the newest in bit 0
  std::uint8_t calm = 0;     ///< updates since it last came or went; stays at 255
};

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
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(presences_.size()); }
  [[nodiscard]] std::uint32_t visible() const { return visible_; }
  [[nodiscard]] const Presence& presence(std::uint32_t index) const { return presences_[index]; }
  [[nodiscard]] const PatchShape& shape(std::uint32_t index) const { return shapes_[index]; }
  [[nodiscard]] Block& block(std::uint32_t index) { return blocks_[index]; }
  [[nodiscard]] const Block& block(std::uint32_t index) const { return blocks_[index]; }
  /// Index of the first patch whose id is not below `id`.
  [[nodiscard]] std::uint32_t lower_bound(PatchId id) const;

  /// Notes whether a patch is visible in this update.
  void note(std::uint32_t index, bool visible);
  /// Takes in patches, visible now; ascending, none known before.
  void merge(std::span<const NewResident> arrivals);
  /// Forgets the patches marked; one mark each.
  void drop(const std::vector<bool>& marks);
  void clear();

 private:
  std::vector<Presence> presences_;
  std::vector<PatchShape> shapes_;  ///< beside them
  std::vector<Block> blocks_;
  std::uint32_t visible_ = 0;
};

inline void ResidentSet::note(std::uint32_t index, bool visible) {
  Presence& p = presences_[index];
  p.history = static_cast<std::uint8_t>(std::uint32_t{p.history} << 1U | static_cast<std::uint32_t>(visible));
  if (p.visible == visible) {
    if (p.calm != 255) ++p.calm;
    return;
  }
  p.calm = 0;
  p.visible = visible;
  visible ? ++visible_ : --visible_;
}

}  // namespace atlaswire::codec
