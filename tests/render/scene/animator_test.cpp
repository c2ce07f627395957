#include "render/scene/animator.h"

#include "render/scene/assemble.h"
#include "render/scene/parade.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace atlaswire::render {
namespace {

/// One vertex at (1, 0, 0) below a node at (0, 5, 0) whose parent at (10, 0, 0) turns a quarter about +y in a
/// second.
SceneSource arm() {
  SceneSource source;
  source.meshes.resize(1);
  source.meshes[0].vertices.push_back({.position = {1, 0, 0}});
  source.instances.push_back({0, glm::translate(glm::dmat4(1.0), glm::dvec3(10, 5, 0))});
  Rig& rig = source.rig;
  rig.nodes.resize(2);
  rig.nodes[0].parent = 1;
  rig.nodes[0].translation = {0, 5, 0};
  rig.nodes[1].translation = {10, 0, 0};
  rig.order = {1, 0};
  rig.meshes.resize(1);
  rig.instances.push_back({0, -1});
  RigChannel turn{.node = 1, .path = RigChannel::Path::kRotation, .width = 4};
  turn.times = {0, 1};
  const float half = std::sqrt(0.5F);
  turn.values = {0, 0, 0, 1, 0, half, 0, half};
  rig.clips.push_back({.channels = {turn}, .duration = 1});
  return source;
}

glm::dvec3 first_vertex(const Animator& animator) {
  std::vector<glm::dvec3> out;
  animator.positions(0, out);
  return out.at(0);
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LT(glm::distance(a, b), 1e-6) << a.x << " " << a.y << " " << a.z;
}

TEST(Animator, TurnsChildrenWithTheirParents) {
  const SceneSource source = arm();
  Animator animator(source);
  expect_near(first_vertex(animator), {11, 5, 0});
  const double angle = M_PI / 4;
  animator.pose(0.5);
  expect_near(first_vertex(animator), {10 + std::cos(angle), 5, -std::sin(angle)});
  animator.pose(7.5);
  expect_near(first_vertex(animator), {10 + std::cos(angle), 5, -std::sin(angle)});
  animator.pose(-0.5);
  expect_near(first_vertex(animator), {10 + std::cos(angle), 5, -std::sin(angle)});
}

TEST(Animator, GivesRigidMotionsFromRest) {
  SceneSource source = arm();
  Animator animator(source);
  auto motion = animator.rigid_motion(0);
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->position, glm::dvec3(0.0));
  animator.pose(0.5);
  motion = animator.rigid_motion(0);
  ASSERT_TRUE(motion);
  expect_near(animator.pivot(0), {10, 5, 0});
  expect_near(
      motion->orientation * (glm::dvec3(11, 5, 0) - animator.pivot(0)) + animator.pivot(0) + motion->position,
      first_vertex(animator));

  source.rig.clips[0].channels[0] = {.node = 1, .path = RigChannel::Path::kScale};
  source.rig.clips[0].channels[0].times = {0, 1};
  source.rig.clips[0].channels[0].values = {1, 1, 1, 2, 2, 2};
  Animator growing(source);
  growing.pose(0.5);
  EXPECT_FALSE(growing.rigid_motion(0)) << "growing is not rigid";
  expect_near(first_vertex(growing), {11.5, 7.5, 0});
}

TEST(Animator, MorphsThenSkins) {
  SceneSource source = arm();
  Rig& rig = source.rig;
  rig.nodes[0].weights = {0.0, 0.5};
  rig.meshes[0].morphs = {{glm::vec3(100)}, {glm::vec3(0, 2, 0)}};
  Animator morphed(source);
  EXPECT_TRUE(morphed.deforms(0));
  EXPECT_FALSE(morphed.rigid_motion(0));
  expect_near(first_vertex(morphed), {11, 6, 0});

  // Joint 1 turns about (10, 0, 0); joint 0 is bound where it rests, so that it leaves the vertex in place.
  // The instance's own node no longer counts, and weights need not sum up to 1.
  rig.skins.push_back({.joints = {0, 1}});
  rig.skins[0].inverse_bind = {glm::translate(glm::dmat4(1.0), glm::dvec3(-10, -5, 0)), glm::dmat4(1.0)};
  rig.instances[0].skin = 0;
  rig.meshes[0].joints.push_back({0, 1, 0, 0});
  rig.meshes[0].weights.push_back({1.0F, 3.0F, 0, 0});
  Animator skinned(source);
  const glm::dvec3 bent(1, 1, 0);
  expect_near(first_vertex(skinned), 0.25 * bent + 0.75 * (glm::dvec3(10, 0, 0) + bent));
  skinned.pose(1 - 1e-9);
  // The parent's quarter takes (10, 5, 0) + bent - (10, 5, 0) with it too.
  expect_near(first_vertex(skinned), 0.25 * glm::dvec3(10, 1, 9) + 0.75 * glm::dvec3(10, 1, -1));
}

TEST(Animator, GivesRestForWhatIsNotFinite) {
  SceneSource source = arm();
  source.rig.nodes[0].scale = glm::dvec3(1e308);
  source.rig.nodes[1].scale = glm::dvec3(1e308);
  Animator animator(source);
  animator.pose(0.5);
  expect_near(first_vertex(animator), {11, 5, 0});
  EXPECT_FALSE(animator.rigid_motion(0));
}

TEST(Parade, MovesSmoothlyAndJoinsItsBeginning) {
  const SceneSource source = make_parade({.figures = 2, .cloths = 1, .orbiters = 4});
  Animator animator(source);
  std::vector<glm::dvec3> before;
  std::vector<glm::dvec3> now;
  for (std::uint32_t i = 0; i < source.instances.size(); ++i) {
    animator.pose(8 - 1.0 / 60);
    animator.positions(i, before);
    animator.pose(8);
    animator.positions(i, now);
    double fastest = 0;
    double lowest = 1;
    for (std::size_t v = 0; v < now.size(); ++v) {
      fastest = std::max(fastest, 60 * glm::distance(before[v], now[v]));
      lowest = std::min(lowest, now[v].y);
    }
    EXPECT_LT(fastest, 15) << "metres a second, instance " << i;
    EXPECT_GT(lowest, -0.15) << "feet stay on the floor, instance " << i;
  }
  animator.pose(1.3);
  std::uint32_t rigid = 0;
  std::uint32_t deformed = 0;
  for (std::uint32_t i = 0; i < source.instances.size(); ++i) {
    rigid += animator.rigid_motion(i).has_value();
    deformed += animator.deforms(i);
  }
  EXPECT_EQ(rigid, 5U) << "the floor and four solids";
  EXPECT_EQ(deformed, 3U);
}

TEST(Parade, IsAssembledAtRestAndSaysWhatMoves) {
  const auto scene = assemble(make_parade({.figures = 2, .cloths = 1, .orbiters = 4}));
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->requirements.clips, 1U);
  EXPECT_EQ(scene->requirements.rigid_objects, 3U) << "of four solids one rests";
  EXPECT_EQ(scene->requirements.deformed_parts, 3U);
  EXPECT_NE(explain(scene->requirements).back().find("3 rigid objects"), std::string::npos);
}

TEST(Parade, KeepsItsWeightsWhole) {
  const SceneSource source = make_parade({});
  for (const RigMesh& mesh : source.rig.meshes) {
    for (const auto& weights : mesh.weights) {
      float sum = 0;
      for (const float w : weights) sum += w;
      EXPECT_NEAR(sum, 1.0F, 1e-5F);
    }
  }
}

}  // namespace
}  // namespace atlaswire::render
