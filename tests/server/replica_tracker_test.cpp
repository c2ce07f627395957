#include "server/replica_tracker.h"

#include "render/scene/scene_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <set>

namespace atlaswire::server {
namespace {

using ::testing::ElementsAre;

/// Two patches that share an edge (vertices 1 and 2), far from the origin.
std::shared_ptr<const render::Scene> two_patches() {
  auto scene = std::make_shared<render::Scene>();
  scene->origin = {1e6, 0, 0};
  scene->box = {{-1, -1, 0}, {1, 1, 0}};
  scene->positions = {{-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {1, 1, 0}};
  scene->materials.resize(2);
  scene->materials[1].draw = {PatchClass::Alpha::kMask, true};
  render::Patch a;
  a.positions = {VertexId{0}, VertexId{1}, VertexId{2}, VertexId{2}, VertexId{2}};
  render::Patch b = a;
  b.positions = {VertexId{2}, VertexId{1}, VertexId{3}, VertexId{3}, VertexId{3}};
  b.material = 1;
  scene->patches = {a, b};
  return scene;
}

std::vector<std::uint32_t> ids(const std::vector<codec::NewVertex>& vertices) {
  std::vector<std::uint32_t> out;
  for (const auto& vertex : vertices) out.push_back(value(vertex.id));
  return out;
}

constexpr Block kBlock{0, 0, 3, 3, false};

TEST(ReplicaTracker, SendsEachVertexOnce) {
  ReplicaTracker tracker(two_patches(), 16);
  render::LayoutChange change;
  change.added = {{PatchId{1}, kBlock}};
  const auto first = tracker.update(FrameId{0}, change);
  EXPECT_THAT(ids(first.vertices), ElementsAre(1, 2, 3));
  EXPECT_FALSE(first.reset);
  EXPECT_EQ(first.added[0].draw, (PatchClass{PatchClass::Alpha::kMask, true}));
  change.added = {{PatchId{0}, kBlock}};
  EXPECT_THAT(ids(tracker.update(FrameId{1}, change).vertices), ElementsAre(0));
}

TEST(ReplicaTracker, PointsThatMoveApartHaveGridPointsOfTheirOwn) {
  auto scene = std::make_shared<render::Scene>(*two_patches());
  for (glm::vec3& position : scene->positions) position = {-1, -1, 0};
  auto motion = std::make_shared<render::SceneMotion>();
  motion->parts.resize(1);
  motion->parts[0].mover = {.first_patch = 0, .patch_count = 2, .deforms = true};
  motion->parts[0].positions = {0, 4};
  const std::vector<render::PlacedPatch> blocks{{PatchId{0}, kBlock}, {PatchId{1}, kBlock}};
  ReplicaTracker rigid(scene, 16);
  for (const auto& vertex : rigid.restart(FrameId{0}, blocks).vertices)
    EXPECT_EQ(vertex.position, GridPosition(0, 0, 0));
  scene->motion = motion;
  ReplicaTracker tracker(scene, 16);
  std::set<std::array<std::uint32_t, 3>> places;
  for (const auto& vertex : tracker.restart(FrameId{0}, blocks).vertices) {
    const GridPosition& p = vertex.position;
    places.insert({p.x, p.y, p.z});
    EXPECT_LE(p.x + p.y + p.z, 3U) << "near where they rest";
  }
  EXPECT_EQ(places.size(), 4U);
}

TEST(ReplicaTracker, VerticesStayKnownAfterTheirPatchIsGone) {
  ReplicaTracker tracker(two_patches(), 16);
  render::LayoutChange change;
  change.added = {{PatchId{0}, kBlock}};
  tracker.update(FrameId{0}, change);
  render::LayoutChange gone;
  gone.removed = {PatchId{0}};
  EXPECT_THAT(tracker.update(FrameId{1}, gone).removed, ElementsAre(PatchId{0}));
  EXPECT_TRUE(tracker.update(FrameId{2}, change).vertices.empty());
}

TEST(ReplicaTracker, RestartTellsEverythingAgain) {
  ReplicaTracker tracker(two_patches(), 16);
  render::LayoutChange change;
  change.added = {{PatchId{0}, kBlock}, {PatchId{1}, kBlock}};
  tracker.update(FrameId{0}, change);
  const std::vector<render::PlacedPatch> blocks{{PatchId{1}, kBlock}};
  const auto all = tracker.restart(FrameId{1}, blocks);
  EXPECT_TRUE(all.reset);
  ASSERT_EQ(all.added.size(), 1U);
  EXPECT_THAT(ids(all.vertices), ElementsAre(1, 2, 3));
  change.added = {{PatchId{0}, kBlock}};
  EXPECT_THAT(ids(tracker.update(FrameId{2}, change).vertices), ElementsAre(0)) << "the client forgot it";
}

TEST(ReplicaTracker, TellsWhatPatchesAskForInsteadOfWhatTheyGot) {
  ReplicaTracker tracker(two_patches(), 16);
  render::LayoutChange change{.reset = true};
  std::vector<render::BlockRequest> requests{{PatchId{0}, 4, 2, true}, {PatchId{1}, 3, 3, false}};
  std::vector<render::PlacedPatch> live{{PatchId{0}, {0, 0, 4, 2, true}}};  // no room for the other
  const auto all = tracker.restart(FrameId{0}, {requests, &change, live});
  EXPECT_TRUE(all.reset);
  ASSERT_TRUE(all.cue);
  EXPECT_TRUE(all.cue->reset);
  ASSERT_EQ(all.added.size(), 2U);
  EXPECT_EQ(all.added[0].block, (Block{0, 0, 4, 2, true}));
  EXPECT_EQ(all.added[1].block, (Block{0, 0, 3, 3, false}));

  change = {.added = {{PatchId{1}, {16, 0, 3, 3, false}}}, .removed = {PatchId{0}}};
  requests = {{PatchId{1}, 3, 3, false}};
  const auto gone = tracker.update(FrameId{1}, {requests, &change, {}});
  EXPECT_THAT(gone.removed, ElementsAre(PatchId{0}));
  EXPECT_TRUE(gone.added.empty()) << "it asked before; that it has a block now is the receiver's to know";
  EXPECT_FALSE(gone.cue->reset);
  EXPECT_NE(gone.cue->check, all.cue->check);

  requests = {{PatchId{0}, 1, 1, false}, {PatchId{1}, 3, 2, false}};
  const auto third = tracker.update(FrameId{2}, {requests, &change, {}});
  EXPECT_TRUE(third.vertices.empty());
  ASSERT_EQ(third.added.size(), 1U);
  ASSERT_EQ(third.moved.size(), 1U);
  EXPECT_EQ(third.moved[0].id, PatchId{1});
  EXPECT_EQ(third.moved[0].block, (Block{0, 0, 3, 2, false}));
}

TEST(ReplicaTracker, PositionsAreSceneCoordinatesWithinTheGridsError) {
  const auto scene = two_patches();
  ReplicaTracker tracker(scene, 12);
  render::LayoutChange change;
  change.added = {{PatchId{0}, kBlock}, {PatchId{1}, kBlock}};
  for (const auto& vertex : tracker.update(FrameId{0}, change).vertices) {
    const glm::dvec3 exact = scene->origin + glm::dvec3(scene->positions[value(vertex.id)]);
    EXPECT_LE(glm::length(tracker.grid().position(vertex.position) - exact),
              tracker.grid().max_error() * 1.0001);
  }
}

TEST(ReplicaTracker, LimitsCoverTheScene) {
  const ReplicaTracker tracker(two_patches(), 14);
  const auto limits = tracker.limits({256, 128});
  EXPECT_EQ(limits.max_vertices, 4U);
  EXPECT_EQ(limits.max_patches, 2U);
  EXPECT_EQ(limits.grid_bits, 14U);
  EXPECT_EQ(limits.atlas, (Extent2D{256, 128}));
}

}  // namespace
}  // namespace atlaswire::server
