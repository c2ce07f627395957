#include "render/scene/subdivide.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <map>
#include <set>

namespace atlaswire::render {
namespace {

SourceMesh quad(float width, float height) {
  SourceMesh mesh;
  for (const glm::vec2 uv : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
    SourceVertex v;
    v.position = {uv.x * width, uv.y * height, 0};
    v.normal = {0, 0, 1};
    v.tangent = {1, 0, 0, 1};
    v.uv = uv;
    mesh.vertices.push_back(v);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

float twice_area(const SourceMesh& mesh) {
  float sum = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto at = [&](std::size_t c) { return mesh.vertices[mesh.indices[i + c]].position; };
    sum += glm::cross(at(1) - at(0), at(2) - at(0)).z;  // signed: a flipped triangle would take away
  }
  return sum;
}

TEST(Subdivide, LeavesNoLongEdgeAndKeepsSurfaceWindingAndTexture) {
  for (const auto& [width, height] : {std::pair{7.0F, 5.0F}, {40.0F, 0.3F}, {1.0F, 1.0F}}) {
    SourceMesh mesh = quad(width, height);
    subdivide(mesh, 1.5F);
    EXPECT_NEAR(twice_area(mesh), 2 * width * height, 1e-3F);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      for (std::size_t c = 0; c < 3; ++c) {
        const SourceVertex& a = mesh.vertices[mesh.indices[i + c]];
        const SourceVertex& b = mesh.vertices[mesh.indices[i + (c + 1) % 3]];
        EXPECT_LE(glm::distance(a.position, b.position), 1.5F);
        EXPECT_NEAR(a.uv.x * width, a.position.x, 1e-5F);
        EXPECT_NEAR(a.uv.y * height, a.position.y, 1e-5F);
      }
    }
  }
}

TEST(Subdivide, LeavesNoTJunction) {
  SourceMesh mesh = quad(9, 4);
  subdivide(mesh, 1.0F);
  // Inside the quad every edge has its opposite; only the rim's stand alone.
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    for (std::size_t c = 0; c < 3; ++c) edges.insert({mesh.indices[i + c], mesh.indices[i + (c + 1) % 3]});
  }
  for (const auto& [a, b] : edges) {
    if (edges.count({b, a}) == 1) continue;
    const glm::vec3 p = mesh.vertices[a].position;
    const glm::vec3 q = mesh.vertices[b].position;
    const bool on_rim = (p.x == q.x && (p.x == 0 || p.x == 9)) || (p.y == q.y && (p.y == 0 || p.y == 4));
    EXPECT_TRUE(on_rim) << p.x << "," << p.y << " " << q.x << "," << q.y;
  }
}

TEST(Subdivide, LeavesSmallTrianglesAlone) {
  SourceMesh mesh = quad(1, 1);
  const auto before = mesh.indices;
  subdivide(mesh, 1.5F);
  EXPECT_EQ(mesh.indices, before);
}

TEST(SuitedLongestEdge, GrowsUntilThePriceIsBounded) {
  SceneSource small;
  small.meshes.push_back(quad(20, 20));
  small.instances.push_back({0, glm::dmat4(1.0)});
  EXPECT_EQ(suited_longest_edge(small), 1.5F);
  SceneSource large;
  large.meshes.push_back(quad(20'000, 20'000));
  large.instances.push_back({0, glm::dmat4(1.0)});
  const float longest = suited_longest_edge(large);
  EXPECT_GT(longest, 1.5F);
  SourceMesh mesh = large.meshes[0];
  subdivide(mesh, longest);
  EXPECT_LT(mesh.indices.size() / 3, 60'000U);
}

}  // namespace
}  // namespace atlaswire::render
