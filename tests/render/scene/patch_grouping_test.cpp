#include "render/scene/patch_grouping.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>

namespace atlaswire::render {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

struct Mesh {
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint16_t> materials;

  [[nodiscard]] std::vector<TriangleGroup> group(const PatchSettings& settings = {}) const {
    return group_triangles({positions, indices, materials}, settings);
  }
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint16_t material = 0) {
    indices.insert(indices.end(), {a, b, c});
    materials.push_back(material);
  }
};

Mesh grid(std::uint32_t side) {
  Mesh mesh;
  for (std::uint32_t y = 0; y <= side; ++y) {
    for (std::uint32_t x = 0; x <= side; ++x)
      mesh.positions.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.0F);
  }
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t a = y * (side + 1) + x;
      const std::uint32_t d = a + side + 1;
      mesh.add(a, a + 1, d + 1);
      mesh.add(a, d + 1, d);
    }
  }
  return mesh;
}

/// A triangle from its lowest corner on: equal for equal windings only.
Triangle canonical(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

/// Every triangle of the mesh in exactly one group, wound as it was.
void expect_partition(const Mesh& mesh, const std::vector<TriangleGroup>& groups) {
  std::multiset<Triangle> wanted;
  std::multiset<Triangle> got;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    wanted.insert(canonical({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]}));
  }
  for (const TriangleGroup& group : groups) {
    for (std::uint32_t t = 0; t < group.count; ++t) {
      const auto corners = patch_triangle(group.count, t);
      got.insert(
          canonical({group.corners[corners[0]], group.corners[corners[1]], group.corners[corners[2]]}));
    }
  }
  EXPECT_EQ(got, wanted);
}

std::map<int, int> shares(const std::vector<TriangleGroup>& groups) {
  std::map<int, int> out;
  for (const TriangleGroup& g : groups) ++out[g.count];
  return out;
}

TEST(GroupTriangles, AGridBecomesItsQuads) {
  const Mesh mesh = grid(12);
  const auto groups = mesh.group();
  expect_partition(mesh, groups);
  EXPECT_EQ(shares(groups), (std::map<int, int>{{2, 144}}));
  for (const TriangleGroup& g : groups) {
    const float diagonal = glm::distance(mesh.positions[g.corners[0]], mesh.positions[g.corners[2]]);
    EXPECT_NEAR(diagonal, std::sqrt(2.0F), 1e-6F) << "the shared edge is 0-2";
  }
}

TEST(GroupTriangles, AStripOfAnOddCountHasOneThreeTrianglePatchAndNoSolo) {
  Mesh mesh;
  for (int i = 0; i < 9; ++i)
    mesh.positions.emplace_back(static_cast<float>(i / 2), static_cast<float>(i % 2), 0.0F);
  for (std::uint32_t i = 0; i < 7; ++i) i % 2 == 0 ? mesh.add(i, i + 2, i + 1) : mesh.add(i, i + 1, i + 2);
  const auto groups = mesh.group();
  expect_partition(mesh, groups);
  EXPECT_EQ(shares(groups), (std::map<int, int>{{2, 2}, {3, 1}}));
}

TEST(GroupTriangles, AugmentingPathsSaveSolos) {
  // The two inner triangles fit best, and matching them would leave both outer ones alone.
  Mesh mesh;
  mesh.positions = {{-1.2F, 0.2F, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2.2F, 0.8F, 0}};
  mesh.add(0, 1, 2);
  mesh.add(1, 3, 2);
  mesh.add(2, 3, 4);
  mesh.add(3, 5, 4);
  const auto groups = mesh.group();
  expect_partition(mesh, groups);
  EXPECT_EQ(shares(groups), (std::map<int, int>{{2, 2}}));
  PatchSettings no_repairs;
  no_repairs.max_repairs = 0;
  EXPECT_NE(shares(mesh.group(no_repairs)), shares(groups)) << "the case must need a repair";
}

TEST(GroupTriangles, MaterialsSeamsAndBendsKeepTrianglesApart) {
  Mesh materials = grid(1);
  materials.materials[1] = 3;
  EXPECT_EQ(shares(materials.group()), (std::map<int, int>{{1, 2}}));

  Mesh seam = grid(1);  // the second triangle with vertices of its own
  const auto base = static_cast<std::uint32_t>(seam.positions.size());
  for (std::uint32_t i = 3; i < 6; ++i) {
    seam.positions.push_back(seam.positions[seam.indices[i]]);
    seam.indices[i] = base + i - 3;
  }
  EXPECT_EQ(shares(seam.group()), (std::map<int, int>{{1, 2}}));

  Mesh fold = grid(1);
  fold.positions[2].z = 2.0F;
  EXPECT_EQ(shares(fold.group()), (std::map<int, int>{{1, 2}}));
}

TEST(GroupTriangles, ASoloTrianglePutsItsSquarestCornerFirst) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {3, 0, 0}, {0, 1, 0}};
  mesh.add(1, 2, 0);
  const auto groups = mesh.group();
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups[0].corners[0], 0U);
  expect_partition(mesh, groups);
}

TEST(GroupTriangles, ManyTrianglesOnOneEdgeAreSurvived) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 1, 0}};
  for (std::uint32_t i = 0; i < 500; ++i) {
    const float angle = static_cast<float>(i) * 0.0125F;
    mesh.positions.emplace_back(std::cos(angle), 0.5F, std::sin(angle));
    i % 2 == 0 ? mesh.add(0, 1, i + 2) : mesh.add(1, 0, i + 2);
  }
  expect_partition(mesh, mesh.group());
}

TEST(GroupTriangles, NothingGivesNothing) { EXPECT_TRUE(Mesh{}.group().empty()); }

}  // namespace
}  // namespace atlaswire::render
