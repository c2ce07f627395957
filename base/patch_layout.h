#pragma once

#include "base/block.h"

#include <array>
#include <compare>
#include <cstdint>
#include <glm/vec2.hpp>
#include <utility>

namespace atlaswire {

/// How 1, 2 or 3 adjacent triangles share one block ([SAS] fig. 4). Corners are numbered counter-clockwise
/// as the triangles wind; the unit square's corner coordinates and the triangles, per patch size:
///   1: (0,0) (1,0) (0,1)                      {0,1,2}
///   2: (0,0) (1,0) (1,1) (0,1)                {0,1,2} {0,2,3}
///   3: (0,0) (1,0) (1,1) (1/2,1) (0,1)        {0,1,3} {1,2,3} {0,3,4}
/// Server and client both use these tables, and give shaders what follows from them.
inline constexpr std::uint32_t kMaxPatchTriangles = 3;
inline constexpr std::uint32_t kMaxPatchCorners = 5;

/// Corners of a patch with `triangles` triangles: triangles + 2.
constexpr std::uint32_t corner_count(std::uint32_t triangles) { return triangles + 2; }

/// Corner indices of triangle `t` of a patch of `triangles` triangles.
constexpr std::array<std::uint8_t, 3> patch_triangle(std::uint32_t triangles, std::uint32_t t) {
  constexpr std::array<std::uint8_t, 3> kOne{0, 1, 2};
  constexpr std::array<std::array<std::uint8_t, 3>, 2> kTwo{{{0, 1, 2}, {0, 2, 3}}};
  constexpr std::array<std::array<std::uint8_t, 3>, 3> kThree{{{0, 1, 3}, {1, 2, 3}, {0, 3, 4}}};
  return triangles == 1 ? kOne : triangles == 2 ? kTwo[t] : kThree[t];
}

/// Unit-square coordinates of corner `corner`.
constexpr std::array<float, 2> corner_coordinate(std::uint32_t triangles, std::uint32_t corner) {
  constexpr std::array<std::array<float, 2>, 3> kOne{{{0, 0}, {1, 0}, {0, 1}}};
  constexpr std::array<std::array<float, 2>, 4> kTwo{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  constexpr std::array<std::array<float, 2>, 5> kThree{{{0, 0}, {1, 0}, {1, 1}, {0.5F, 1}, {0, 1}}};
  return triangles == 1 ? kOne[corner] : triangles == 2 ? kTwo[corner] : kThree[corner];
}

/// Atlas texel coordinates of a corner: inset by half a texel from the block's edges ([SAS] fig. 6).
inline glm::vec2 corner_texel(const Block& block, std::uint32_t triangles, std::uint32_t corner) {
  auto [u, v] = corner_coordinate(triangles, corner);
  if (block.transposed) std::swap(u, v);
  return {static_cast<float>(block.x) + 0.5F + u * static_cast<float>(block.width() - 1),
          static_cast<float>(block.y) + 0.5F + v * static_cast<float>(block.height() - 1)};
}

/// How a client must draw a patch: what its triangles' material demands.
struct PatchClass {
  enum class Alpha : std::uint8_t { kOpaque = 0, kMask = 1, kBlend = 2 };
  Alpha alpha = Alpha::kOpaque;
  bool double_sided = false;
  auto operator<=>(const PatchClass&) const = default;
};

}  // namespace atlaswire
