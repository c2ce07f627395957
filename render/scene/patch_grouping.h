#pragma once

#include "base/patch_layout.h"

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <numbers>
#include <span>
#include <vector>

namespace atlaswire::render {

/// How triangles are put together to patches.
struct PatchSettings {
  /// Radians: neighbours whose planes bend by more stay apart. More gives fewer solo triangles, but blocks
  /// that show two faces of an edge at one resolution, and patches visible from more sides.
  double max_bend = 25.0 * std::numbers::pi / 180.0;
  /// Fits below this are not made, 0..1 (see quad_fit).
  double min_fit = 0.05;
  /// Matched pairs that one augmenting path may re-pair to save two solo triangles.
  std::uint32_t max_repairs = 4;
};

/// Triangles over shading vertices: two are neighbours only across an edge whose two vertices are the same
/// indices in both, so no seam runs through a patch.
struct TriangleMesh {
  std::span<const glm::vec3> positions;      ///< by shading vertex
  std::span<const std::uint32_t> indices;    ///< 3 a triangle; no triangle is degenerate
  std::span<const std::uint16_t> materials;  ///< by triangle
};

/// One patch to be: its triangles, and its corners in the order of base/patch_layout.h.
struct TriangleGroup {
  std::array<std::uint32_t, kMaxPatchCorners> corners{};  ///< shading vertices; the rest repeat the last
  std::uint32_t triangle = 0;                             ///< the lowest of its triangles
  std::uint8_t count = 1;
};

/// Groups all triangles into patches of 1 to 3 ([SAS] fig. 4): a greedy matching by best fit, improved by
/// augmenting paths; what stays solo joins a neighbouring pair as its third. The paper's own heuristic is
/// unpublished. Deterministic; near linear time. Groups come in order of their lowest triangle.
std::vector<TriangleGroup> group_triangles(const TriangleMesh& mesh, const PatchSettings& settings);

}  // namespace atlaswire::render
