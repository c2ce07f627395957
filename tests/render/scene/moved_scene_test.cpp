#include "render/scene/moved_scene.h"

#include "render/scene/assemble.h"
#include "render/scene/load.h"
#include "render/scene/parade.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <set>

namespace atlaswire::render {
namespace {

constexpr ParadeOptions kParade{.figures = 2, .cloths = 1, .orbiters = 4};

std::shared_ptr<const Scene> parade() {
  return std::make_shared<const Scene>(assemble(make_parade(kParade)).value());
}

bool inside(const Box& box, const glm::vec3& p) {
  return p.x >= box.low.x && p.y >= box.low.y && p.z >= box.low.z && p.x <= box.high.x && p.y <= box.high.y &&
         p.z <= box.high.z;
}

TEST(SceneMotion, EachPartHasWhatItUsesForItself) {
  const auto scene = parade();
  ASSERT_TRUE(scene->motion);
  const auto& parts = scene->motion->parts;
  ASSERT_EQ(parts.size(), 6U);
  std::vector<std::uint32_t> owner_of_vertex(scene->vertices.size(), 0);
  std::vector<std::uint32_t> owner_of_point(scene->positions.size(), 0);
  const auto owner_of = [&](std::uint32_t patch) {
    for (std::uint32_t i = 0; i < parts.size(); ++i) {
      if (patch >= parts[i].mover.first_patch && patch < parts[i].mover.end()) return i + 1;
    }
    return 0U;
  };
  std::vector<bool> seen(scene->positions.size(), false);
  for (std::uint32_t p = 0; p < scene->patches.size(); ++p) {
    const std::uint32_t owner = owner_of(p);
    for (std::size_t c = 0; c < kMaxPatchCorners; ++c) {
      const std::uint32_t point = value(scene->patches[p].positions[c]);
      if (!seen[point]) owner_of_point[point] = owner;
      seen[point] = true;
      EXPECT_EQ(owner_of_point[point], owner) << "patch " << p;
      if (owner == 0) continue;
      const MovingPart& part = parts[owner - 1];
      EXPECT_TRUE(point >= part.positions.first && point < part.positions.end());
      const std::uint32_t vertex = scene->patches[p].vertices[c];
      EXPECT_TRUE(vertex >= part.vertices.first && vertex < part.vertices.end());
      EXPECT_EQ(part.positions.first + part.points[vertex - part.vertices.first], point);
    }
  }
  for (std::uint32_t c = 0; c < scene->chunks.size(); ++c) {
    for (const std::uint32_t p : patches_of(*scene, scene->chunks[c])) {
      const std::uint32_t owner = owner_of(p);
      EXPECT_EQ(owner, owner_of(scene->drawn[scene->chunks[c].first_patch]));
      if (owner == 0) continue;
      const NumberRange& chunks = parts[owner - 1].chunks;
      EXPECT_TRUE(c >= chunks.first && c < chunks.end());
    }
  }
  for (std::uint32_t t = 0; t < scene->triangle_patch.size(); ++t) {
    const std::uint32_t owner = owner_of(scene->triangle_patch[t]);
    if (owner == 0) continue;
    const NumberRange& triangles = parts[owner - 1].triangles;
    EXPECT_TRUE(t >= triangles.first && t < triangles.end());
  }
}

TEST(SceneMotion, OfASceneThatRestsThereIsNone) {
  const auto atrium = load_scene("atrium:0.2");
  ASSERT_TRUE(atrium);
  EXPECT_FALSE(atrium->motion);
  MovedScene moved(std::make_shared<const Scene>(*atrium));
  moved.pose(3.0);
  EXPECT_TRUE(moved.parts().empty());
  EXPECT_EQ(moved.vertex(7).position, atrium->vertices[7].position);
}

TEST(MovedScene, PutsEveryPointWhereItsAnimatorHasIt) {
  const auto scene = parade();
  const SceneSource source = make_parade(kParade);
  Animator animator(source);
  MovedScene moved(scene);
  std::vector<glm::dvec3> posed;
  for (const double t : {0.37, 2.9, 5.21}) {
    moved.pose(t);
    animator.pose(t);
    for (std::size_t i = 0; i < moved.parts().size(); ++i) {
      const MovingPart& part = moved.parts()[i];
      animator.positions(part.instance, posed);
      for (std::size_t p = 0; p < moved.positions(i).size(); ++p) {
        const glm::vec3 at = moved.positions(i)[p];
        const auto wanted = [&](const glm::dvec3& q) {
          return glm::distance(glm::vec3(q - scene->origin), at);
        };
        double nearest = 1e9;
        if (part.mover.deforms) {
          nearest = wanted(posed[part.sources[p]]);
        } else {
          for (const glm::dvec3& q : posed) nearest = std::min<double>(nearest, wanted(q));
        }
        ASSERT_LT(nearest, 1e-4) << "part " << i << " point " << p << " at " << t;
      }
      for (std::uint32_t c = part.chunks.first; c < part.chunks.end(); ++c) {
        const Box& box = moved.boxes()[c];
        EXPECT_LE(glm::length(glm::min(box.low, scene->chunks[c].box.low) - scene->chunks[c].box.low), 0.1F);
        for (std::uint32_t v = 0; v < part.vertices.count; ++v) {
          if (part.chunks.count > 1) break;
          ASSERT_TRUE(inside(box, moved.vertices(i)[v].position));
        }
      }
    }
  }
}

TEST(MovedScene, TurnsNormalsWithTheirSurface) {
  const auto scene = parade();
  MovedScene moved(scene);
  moved.pose(1.7);
  for (std::size_t i = 0; i < moved.parts().size(); ++i) {
    const MovingPart& part = moved.parts()[i];
    double worst = 1;
    double sum = 0;
    for (std::uint32_t t = part.triangles.first; t < part.triangles.end(); ++t) {
      std::array<ShadingVertex, 3> rest;
      std::array<ShadingVertex, 3> now;
      for (std::size_t c = 0; c < 3; ++c) {
        rest[c] = scene->vertices[scene->indices[3 * std::size_t{t} + c]];
        now[c] = moved.vertex(scene->indices[3 * std::size_t{t} + c]);
      }
      const auto lean = [](const std::array<ShadingVertex, 3>& v) {
        const glm::vec3 face =
            glm::normalize(glm::cross(v[1].position - v[0].position, v[2].position - v[0].position));
        return glm::dot(face, unpack_normal(v[0].normal));
      };
      worst = std::min<double>(worst, lean(now) - lean(rest));
      sum += std::abs(lean(now) - lean(rest));
    }
    EXPECT_GT(worst, part.mover.deforms ? -0.6 : -1e-3) << "part " << i;
    EXPECT_LT(sum / part.triangles.count, part.mover.deforms ? 0.05 : 1e-3) << "part " << i;
  }
}

TEST(MovedScene, ComesBackToRestAndSaysWhatMoved) {
  const auto scene = parade();
  MovedScene moved(scene);
  for (std::size_t i = 0; i < moved.parts().size(); ++i) EXPECT_EQ(moved.version(i), 0U);
  moved.pose(1.0);
  std::vector<std::uint64_t> versions;
  for (std::size_t i = 0; i < moved.parts().size(); ++i) versions.push_back(moved.version(i));
  EXPECT_EQ(std::set<std::uint64_t>(versions.begin(), versions.end()).size(), versions.size());
  moved.pose(1.0);
  for (std::size_t i = 0; i < moved.parts().size(); ++i)
    EXPECT_EQ(moved.version(i), versions[i]) << "same time";
  moved.pose(std::nullopt);
  for (std::size_t i = 0; i < moved.parts().size(); ++i) {
    const MovingPart& part = moved.parts()[i];
    EXPECT_NE(moved.version(i), versions[i]);
    for (std::uint32_t v = 0; v < part.vertices.count; ++v) {
      EXPECT_EQ(moved.vertices(i)[v].position, scene->vertices[part.vertices.first + v].position);
      EXPECT_EQ(moved.vertices(i)[v].normal, scene->vertices[part.vertices.first + v].normal);
    }
  }
}

TEST(MovedScene, PointsThatPartStayApartAlthoughTheyRestTogether) {
  // A strip of four triangles: two quads that meet at an edge, whose ends each side moves by itself.
  SceneSource source;
  source.name = "lips";
  source.materials.resize(1);
  SourceMesh mesh;
  RigMesh rig;
  rig.morphs.resize(1);
  const auto quad = [&](float from, float to, float lift) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const glm::vec3 p :
         {glm::vec3(0, from, 0), glm::vec3(1, from, 0), glm::vec3(1, to, 0), glm::vec3(0, to, 0)}) {
      mesh.vertices.push_back({.position = p,
                               .normal = {0, 0, 1},
                               .tangent = {1, 0, 0, 1},
                               .rig = static_cast<std::uint32_t>(mesh.vertices.size())});
      rig.morphs[0].push_back({0, lift, 0});
    }
    for (const std::uint32_t c : {0U, 1U, 2U, 0U, 2U, 3U}) mesh.indices.push_back(first + c);
  };
  quad(0, 1, -0.5F);
  quad(1, 2, 0.5F);
  source.meshes.push_back(mesh);
  source.instances.push_back({0});
  source.rig.nodes.resize(1);
  source.rig.nodes[0].weights = {0};
  source.rig.order = {0};
  source.rig.meshes.push_back(rig);
  source.rig.instances.push_back({0, -1});
  RigChannel open{.node = 0, .path = RigChannel::Path::kWeights, .width = 1};
  open.times = {0, 1};
  open.values = {0, 1};
  source.rig.clips.push_back({.channels = {open}, .duration = 1});
  const auto scene = std::make_shared<const Scene>(assemble(source).value());
  EXPECT_EQ(scene->positions.size(), 8U);
  MovedScene moved(scene);
  moved.pose(0.5);
  float low = 1e9F;
  float high = -1e9F;
  for (const glm::vec3& p : moved.positions(0)) {
    low = std::min(low, p.y);
    high = std::max(high, p.y);
  }
  EXPECT_NEAR(high - low, 2.5F, 1e-5F);
  // The same without the difference: one surface, six points.
  for (glm::vec3& morph : source.rig.meshes[0].morphs[0]) morph = {0, 0.5F, 0};
  EXPECT_EQ(assemble(source)->positions.size(), 6U);
}

}  // namespace
}  // namespace atlaswire::render
