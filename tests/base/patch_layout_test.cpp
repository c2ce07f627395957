#include "base/patch_layout.h"

#include <gtest/gtest.h>

#include <set>

namespace atlaswire {
namespace {

/// Twice the signed area of a patch's triangle in the unit square.
float doubled_area(std::uint32_t triangles, std::uint32_t t) {
  const auto corners = patch_triangle(triangles, t);
  const auto a = corner_coordinate(triangles, corners[0]);
  const auto b = corner_coordinate(triangles, corners[1]);
  const auto c = corner_coordinate(triangles, corners[2]);
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

TEST(PatchLayout, TrianglesWindAlikeAndFillTheSquareFromTwoUp) {
  for (std::uint32_t triangles = 1; triangles <= kMaxPatchTriangles; ++triangles) {
    float sum = 0;
    std::set<std::uint8_t> used;
    for (std::uint32_t t = 0; t < triangles; ++t) {
      EXPECT_GT(doubled_area(triangles, t), 0) << triangles << " " << t;
      sum += doubled_area(triangles, t);
      for (const std::uint8_t corner : patch_triangle(triangles, t)) used.insert(corner);
    }
    EXPECT_FLOAT_EQ(sum, triangles == 1 ? 1.0F : 2.0F);
    EXPECT_EQ(used.size(), corner_count(triangles));
  }
}

TEST(CornerTexel, IsInsetByHalfATexel) {
  const Block block{.x = 8, .y = 16, .width_log2 = 3, .height_log2 = 2, .transposed = false};
  EXPECT_EQ(corner_texel(block, 2, 0), glm::vec2(8.5F, 16.5F));
  EXPECT_EQ(corner_texel(block, 2, 2), glm::vec2(15.5F, 19.5F));
}

TEST(CornerTexel, TransposedBlockSwapsTheAxes) {
  const Block block{.x = 0, .y = 0, .width_log2 = 3, .height_log2 = 2, .transposed = true};
  EXPECT_EQ(corner_texel(block, 2, 1), glm::vec2(0.5F, 3.5F));
  EXPECT_EQ(corner_texel(block, 2, 3), glm::vec2(7.5F, 0.5F));
}

TEST(CornerTexel, BlockOfOneTexelIsItsCentre) {
  const Block block{.x = 5, .y = 6};
  for (std::uint32_t corner = 0; corner < 5; ++corner) {
    EXPECT_EQ(corner_texel(block, 3, corner), glm::vec2(5.5F, 6.5F));
  }
}

}  // namespace
}  // namespace atlaswire
