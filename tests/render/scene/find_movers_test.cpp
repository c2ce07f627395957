#include "render/scene/find_movers.h"

#include "base/mover.h"
#include "render/scene/parade.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace atlaswire::render {
namespace {

/// One instance at node 0 below node 1, one triangle; a clip with one channel of two keys.
SceneSource arm(std::uint32_t node, RigChannel::Path path, std::vector<float> values) {
  SceneSource source;
  source.meshes.resize(1);
  source.meshes[0].vertices.resize(3);
  source.meshes[0].indices = {0, 1, 2};
  source.instances.push_back({0});
  Rig& rig = source.rig;
  rig.nodes.resize(2);
  rig.nodes[0].parent = 1;
  rig.order = {1, 0};
  rig.meshes.resize(1);
  rig.instances.push_back({0, -1});
  RigChannel channel{.node = node, .path = path, .width = static_cast<std::uint32_t>(values.size() / 2)};
  channel.times = {0, 1};
  channel.values = std::move(values);
  rig.clips.push_back({.channels = {channel}, .duration = 1});
  return source;
}

const std::vector<float> kTurn{0, 0, 0, 1, 0, 1, 0, 0};

TEST(FindMovers, WhatTurnsOrGoesIsRigid) {
  EXPECT_EQ(find_movers(arm(0, RigChannel::Path::kRotation, kTurn)).at(0), InstanceMotion::kRigid);
  EXPECT_EQ(find_movers(arm(1, RigChannel::Path::kTranslation, {0, 0, 0, 1, 0, 0})).at(0),
            InstanceMotion::kRigid);
}

TEST(FindMovers, WhatIsScaledDeformsButNotByATrackThatKeepsTheScale) {
  EXPECT_EQ(find_movers(arm(1, RigChannel::Path::kScale, {1, 1, 1, 2, 1, 1})).at(0),
            InstanceMotion::kDeforms);
  SceneSource kept = arm(1, RigChannel::Path::kScale, {2, 3, 4, 2, 3, 4});
  kept.rig.nodes[1].scale = {2, 3, 4};
  EXPECT_EQ(find_movers(kept).at(0), InstanceMotion::kRests);
}

TEST(FindMovers, WhatTurnsBelowAnUnevenScaleDeforms) {
  SceneSource source = arm(0, RigChannel::Path::kRotation, kTurn);
  source.rig.nodes[1].scale = {1, 2, 1};
  EXPECT_EQ(find_movers(source).at(0), InstanceMotion::kDeforms);
  // Its own scale turns with it.
  source.rig.nodes[1].scale = {2, 2, 2};
  source.rig.nodes[0].scale = {1, 2, 1};
  EXPECT_EQ(find_movers(source).at(0), InstanceMotion::kRigid);
  glm::dmat4 skewed(1.0);
  skewed[1][0] = 0.5;
  source.rig.nodes[1].matrix = skewed;
  EXPECT_EQ(find_movers(source).at(0), InstanceMotion::kDeforms);
}

TEST(FindMovers, WhatNothingAboveMovesRests) {
  SceneSource source = arm(1, RigChannel::Path::kTranslation, {0, 0, 0, 1, 0, 0});
  source.rig.nodes.emplace_back();
  source.rig.order.push_back(2);
  source.instances.push_back({0});
  source.rig.instances.push_back({2, -1});
  const auto motions = find_movers(source);
  EXPECT_EQ(motions.at(0), InstanceMotion::kRigid);
  EXPECT_EQ(motions.at(1), InstanceMotion::kRests);
  source.rig.clips.clear();
  EXPECT_EQ(find_movers(source).at(0), InstanceMotion::kRests) << "no clip";
}

TEST(FindMovers, KeepsTheLargestOfTooMany) {
  SceneSource source = arm(1, RigChannel::Path::kTranslation, {0, 0, 0, 1, 0, 0});
  source.meshes.push_back(source.meshes[0]);
  source.meshes[1].indices = {0, 1, 2, 2, 1, 0};
  source.rig.meshes.resize(2);
  source.instances.assign(kMostMovers + 5, SourceInstance{0});
  source.instances.back().mesh = 1;
  source.rig.instances.assign(source.instances.size(), {0, -1});
  const auto motions = find_movers(source);
  EXPECT_EQ(std::ranges::count(motions, InstanceMotion::kRigid), std::ptrdiff_t{kMostMovers});
  EXPECT_EQ(motions.back(), InstanceMotion::kRigid);
}

TEST(FindMovers, SkinsAndMorphsDeform) {
  const SceneSource source = make_parade({.figures = 1, .cloths = 1, .orbiters = 4});
  const auto motions = find_movers(source);
  EXPECT_EQ(std::ranges::count(motions, InstanceMotion::kDeforms), 2);
  EXPECT_EQ(std::ranges::count(motions, InstanceMotion::kRigid), 3);
  EXPECT_EQ(std::ranges::count(motions, InstanceMotion::kRests), 2);
}

}  // namespace
}  // namespace atlaswire::render
