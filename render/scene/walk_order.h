#pragma once

#include "render/scene/patch_grouping.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace atlaswire::render {

/// An order of patches in which each lies beside one of the few before it where the surface allows: numbers
/// close together then mean neighbours, which the geometry codec predicts by (docs/PROTOCOL.md, "Shapes").
/// Part after part of the surface is walked: each begins where it touches what was walked most (of equals at
/// the first given), goes to the neighbour that does, and where there is none back to the latest patch that
/// has one. Neighbours share an
/// edge by position, whatever seams run there. Deterministic; near linear time.
class WalkOrder {
 public:
  WalkOrder(std::span<const glm::vec3> positions, std::span<const TriangleGroup> groups);

  /// Reorders the next part: numbers of groups, none of which was in a part before.
  void arrange(std::span<std::uint32_t> part);

 private:
  void walk_from(std::uint32_t start);
  [[nodiscard]] std::span<const std::uint32_t> neighbours(std::uint32_t group) const {
    return std::span(neighbours_).subspan(first_[group], first_[group + 1] - first_[group]);
  }
  [[nodiscard]] std::uint32_t next_from(std::uint32_t group) const;
  void visit(std::uint32_t group);

  enum class Where : std::uint8_t { kLater, kInPart, kWalked };

  std::vector<std::uint32_t> first_;       ///< by group: into `neighbours_`; one more at the end
  std::vector<std::uint32_t> neighbours_;  ///< groups
  std::vector<std::uint32_t> behind_;      ///< by group: neighbours already walked
  std::vector<Where> where_;               ///< by group
  std::vector<std::uint32_t> walk_;
  std::vector<std::uint32_t> trail_;
};

}  // namespace atlaswire::render
