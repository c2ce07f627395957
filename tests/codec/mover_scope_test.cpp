#include "codec/mover_scope.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace atlaswire::codec {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Patches 10..19 and 30..39 deform, 20..24 and 25..29 are of one rigid object, 50 of another.
const std::vector<Mover> kMovers{
    {10, 10, true, 0}, {20, 5, false, 0}, {25, 5, false, 0}, {30, 10, true, 0}, {50, 1, false, 1}};

/// A quad whose corners are the vertices first..first + 3.
AddedPatch quad(std::uint32_t id, std::uint32_t first) {
  AddedPatch patch{.id = PatchId{id}, .triangles = 2};
  for (std::uint32_t c = 0; c < 4; ++c) patch.corners[c] = VertexId{first + c};
  return patch;
}

/// Vertices of the ids first..end, each at its id on the x axis.
std::vector<NewVertex> vertices(std::uint32_t first, std::uint32_t end) {
  std::vector<NewVertex> out;
  for (std::uint32_t v = first; v < end; ++v) out.push_back({VertexId{v}, {v, 0, 0}});
  return out;
}

TEST(FindMover, IsOfAPatchWithinARunOnly) {
  EXPECT_EQ(find_mover(kMovers, PatchId{9}), nullptr);
  EXPECT_EQ(find_mover(kMovers, PatchId{10}), &kMovers[0]);
  EXPECT_EQ(find_mover(kMovers, PatchId{19}), &kMovers[0]);
  EXPECT_EQ(find_mover(kMovers, PatchId{25}), &kMovers[2]);
  EXPECT_EQ(find_mover(kMovers, PatchId{40}), nullptr);
  EXPECT_EQ(find_mover(kMovers, PatchId{51}), nullptr);
}

TEST(MoverScope, IsWhatIsVisibleOfMovers) {
  MoverWatch watch(kMovers);
  MoverScope scope(kMovers, 1);
  MetaUpdate update;
  update.reset = true;
  update.vertices = vertices(0, 20);
  update.added = {quad(50, 0), quad(12, 4), quad(11, 6), quad(3, 8), quad(22, 0)};
  scope.follow(watch.take(update));
  // By ascending patch: 11 has vertices 6..9, 12 then 4, 5 and shares 6, 7.
  EXPECT_THAT(scope.scope().vertices, ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(scope.scope().objects, ElementsAre(0, 1));
  EXPECT_EQ(scope.surface().rest(0), GridPosition(6, 0, 0));
  EXPECT_EQ(scope.id(4), VertexId{4});
  EXPECT_THAT(scope.corners(PatchId{12}), ElementsAre(4, 5, 0, 1));
  EXPECT_THAT(scope.surface().neighbours(5), ElementsAre(4, 0));
  EXPECT_THAT(scope.corners(PatchId{22}), IsEmpty());
  EXPECT_THAT(scope.corners(PatchId{13}), IsEmpty());

  MetaUpdate next;
  next.removed = {PatchId{11}, PatchId{50}, PatchId{3}};
  next.added = {quad(26, 0)};
  scope.follow(watch.take(next));
  EXPECT_THAT(scope.scope().vertices, ElementsAre(0, 1, 4, 5)) << "2 and 3 were of the patch that went";
  EXPECT_THAT(scope.scope().objects, ElementsAre(0));
  EXPECT_EQ(scope.surface().size(), 6U) << "who went stays known";

  next = {};
  next.added = {quad(11, 6)};
  scope.follow(watch.take(next));
  EXPECT_EQ(scope.surface().size(), 6U) << "and comes back as the same";
}

TEST(MoverScope, MoversShareNoVertexAlthoughTheyRestTogether) {
  MoverWatch watch(kMovers);
  MoverScope scope(kMovers, 1);
  MetaUpdate update;
  update.vertices = vertices(0, 4);
  update.added = {quad(10, 0), quad(30, 0)};
  scope.follow(watch.take(update));
  EXPECT_EQ(scope.surface().size(), 8U);
  EXPECT_THAT(scope.corners(PatchId{30}), ElementsAre(4, 5, 6, 7));
}

TEST(MoverScope, OfOtherNumbersForOnePositionIsTheSame) {
  MoverScope scope(kMovers, 1);
  MoverScope other(kMovers, 99);
  MoverWatch watch(kMovers);
  MoverWatch other_watch(kMovers);
  MetaUpdate update;
  update.vertices = vertices(0, 12);
  update.vertices[7].position = update.vertices[2].position;
  update.added = {quad(15, 0), quad(16, 5)};
  MetaUpdate told = update;
  std::swap(told.added[0], told.added[1]);
  std::vector<VertexId> numbers;
  for (NewVertex& v : told.vertices) v.id = VertexId{100 - value(v.id)};
  for (AddedPatch& patch : told.added) {
    for (VertexId& corner : patch.corners) corner = VertexId{100 - value(corner)};
  }
  scope.follow(watch.take(update));
  other.follow(other_watch.take(told));
  ASSERT_EQ(scope.surface().size(), 7U);
  ASSERT_EQ(other.surface().size(), 7U);
  for (std::uint32_t v = 0; v < 7; ++v) {
    EXPECT_EQ(scope.surface().rest(v), other.surface().rest(v));
    EXPECT_TRUE(std::ranges::equal(scope.surface().neighbours(v), other.surface().neighbours(v)));
  }
}

TEST(MoverScope, SurvivesUpdatesThatNoReplicaWouldTake) {
  MoverWatch watch(kMovers);
  MoverScope scope(kMovers, 1);
  MetaUpdate wild;
  wild.removed = {PatchId{11}, PatchId{11}, PatchId{~0U}};
  wild.added = {quad(11, 5000), quad(11, 3), quad(50, 1), quad(50, 1), quad(~0U, 0)};
  wild.added[0].triangles = 200;
  scope.follow(watch.take(wild));
  scope.follow(watch.take(wild));
  EXPECT_THAT(scope.scope().objects, ElementsAre(1));
  MetaUpdate all_gone;
  all_gone.removed = {PatchId{11}, PatchId{50}};
  scope.follow(watch.take(all_gone));
  EXPECT_THAT(scope.scope().objects, IsEmpty());
  EXPECT_THAT(scope.scope().vertices, IsEmpty());
}

}  // namespace
}  // namespace atlaswire::codec
