#include "base/random.h"
#include "tests/render/atlas/layout_checker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace atlaswire::render {
namespace {

bool same(const BlockRequest& a, const BlockRequest& b) {
  return a.patch == b.patch && a.width_log2 == b.width_log2 && a.height_log2 == b.height_log2 &&
         a.transposed == b.transposed;
}

/// What changes from list to list, and now and then a request that stands.
class Changes {
 public:
  RequestChange next(const std::vector<BlockRequest>& visible) {
    gone_.clear();
    asked_.clear();
    auto old = before_.begin();
    for (const BlockRequest& r : visible) {
      while (old != before_.end() && old->patch < r.patch) gone_.push_back((old++)->patch);
      const bool stands = old != before_.end() && same(*old, r);
      if (old != before_.end() && old->patch == r.patch) ++old;
      if (!stands || random_.below(20) == 0) asked_.push_back(r);
    }
    while (old != before_.end()) gone_.push_back((old++)->patch);
    before_ = visible;
    return {gone_, asked_};
  }

 private:
  Random random_{17};
  std::vector<BlockRequest> before_;
  std::vector<PatchId> gone_;
  std::vector<BlockRequest> asked_;
};

bool equal(const std::vector<PlacedPatch>& a, const std::vector<PlacedPatch>& b) {
  return std::ranges::equal(
      a, b, [](const auto& l, const auto& r) { return l.patch == r.patch && l.block == r.block; });
}

/// Empty if two allocators did and hold the same, else what differs.
std::string difference(const AtlasAllocator& a, const LayoutChange& change_a, const AtlasAllocator& b,
                       const LayoutChange& change_b) {
  if (change_a.reset != change_b.reset) return "reset";
  if (!equal(change_a.added, change_b.added)) return "added";
  if (!equal(change_a.moved, change_b.moved)) return "moved";
  if (change_a.removed != change_b.removed) return "removed";
  if (change_a.refused != change_b.refused) return "refused";
  if (!equal(a.blocks(), b.blocks())) return "blocks()";
  if (a.usage().free != b.usage().free || a.usage().on_stacks != b.usage().on_stacks) return "usage()";
  return a.wants_reset() == b.wants_reset() ? "" : "wants_reset()";
}

/// What a history had in it.
struct Events {
  int resets = 0;
  std::size_t refused = 0;
  std::size_t shrunken = 0;
  std::size_t regrown = 0;

  void take_in(const LayoutChange& change, const RequestChange& asked, std::span<const PlacedPatch> blocks,
               std::span<const BlockRequest> visible) {
    resets += change.reset ? 1 : 0;
    refused += change.refused.size();
    for (const PlacedPatch& moved : change.moved) {
      regrown +=
          !change.reset && !std::ranges::binary_search(asked.asked, moved.patch, {}, &BlockRequest::patch);
    }
    auto held = blocks.begin();
    for (const BlockRequest& r : visible) {
      if (held == blocks.end() || held->patch != r.patch) continue;
      shrunken += held->block.width_log2 + held->block.height_log2 < r.width_log2 + r.height_log2 ? 1 : 0;
      ++held;
    }
  }
};

/// One history as full lists, as changes, and in turn as either.
Events compare(const DriftLoad& run) {
  const auto full = make_sequential_allocator(run.settings, run.patches);
  const auto changes = make_sequential_allocator(run.settings, run.patches);
  const auto either = make_sequential_allocator(run.settings, run.patches);
  DriftingScene scene(23, run.patches, run.settings);
  Changes maker;
  Events events;
  for (int frame = 0; frame < run.frames; ++frame) {
    const double visible = frame / 40 % 2 == 0 ? run.visible : run.visible / 2;
    const auto& list = scene.step(frame == 0 ? 1.0 : run.churn, visible, run.largest_log2);
    const RequestChange change = maker.next(list);
    const bool may_reset = frame % 7 == 0;
    if (frame % 150 == 100) {
      for (const auto& allocator : {full.get(), changes.get(), either.get()}) allocator->restart();
    }
    const LayoutChange& of_full = full->update(list, may_reset);
    const LayoutChange& of_changes = changes->update_by(change, may_reset);
    const LayoutChange& of_either =
        frame % 3 == 1 ? either->update(list, may_reset) : either->update_by(change, may_reset);
    const std::string by_changes = difference(*full, of_full, *changes, of_changes);
    const std::string by_either = difference(*full, of_full, *either, of_either);
    events.take_in(of_full, change, full->blocks(), list);
    EXPECT_EQ(by_changes, "") << run.name << ", frame " << frame;
    EXPECT_EQ(by_either, "") << run.name << ", frame " << frame << ", list and changes in turn";
    if (testing::Test::HasFailure()) break;
  }
  return events;
}

TEST(IncrementalAllocator, ChangesLeadToTheSameLayoutsAsFullLists) {
  const std::array loads{
      DriftLoad{"comfortable", small_atlas(), 600, 0.05, 0.4, 4, 1500},
      DriftLoad{"overload", small_atlas(), 3000, 0.05, 0.5, 4, 300},
      DriftLoad{"calm_overload", small_atlas(128), 300, 0.01, 0.6, 4, 1500},
      DriftLoad{"all_new_every_frame", small_atlas(), 400, 1.0, 0.5, 5, 300},
      DriftLoad{"one_superblock", small_atlas(32, 5, 1), 40, 0.2, 0.5, 5, 2000},
      DriftLoad{"one_texel_blocks", small_atlas(64, 4, 0), 3000, 0.1, 0.7, 1, 200},
      DriftLoad{"fewer_blocks_than_patches", small_atlas(64, 4, 3), 300, 0.2, 0.8, 4, 600}};
  Events all;
  for (const DriftLoad& load : loads) {
    const Events events = compare(load);
    all.resets += events.resets;
    all.refused += events.refused;
    all.shrunken += events.shrunken;
    all.regrown += events.regrown;
  }
  EXPECT_GT(all.resets, 50);
  EXPECT_GT(all.refused, 1000U);
  EXPECT_GT(all.shrunken, 1000U);
  EXPECT_GT(all.regrown, 100U);
}

std::vector<PatchId> patches(std::uint32_t first, std::uint32_t end) {
  std::vector<PatchId> out;
  for (std::uint32_t i = first; i < end; ++i) out.push_back(PatchId{i});
  return out;
}

/// Each patch asks for 16 x 16 texels.
std::vector<BlockRequest> squares(std::uint32_t first, std::uint32_t end) {
  std::vector<BlockRequest> out;
  for (std::uint32_t i = first; i < end; ++i) out.push_back(request(i, 4, 4));
  return out;
}

TEST(IncrementalAllocator, ARefusedPatchStillAsksThoughItIsNotNamedAgain) {
  const auto allocator = make_sequential_allocator(small_atlas(4, 2, 1), 6);  // four smallest blocks
  const auto six = squares(0, 6);
  EXPECT_EQ(allocator->update_by({.gone = {}, .asked = six}, false).refused, patches(4, 6));
  const auto gone = patches(1, 2);
  const LayoutChange& change = allocator->update_by({.gone = gone, .asked = {}}, false);
  EXPECT_EQ(change.removed, gone);
  ASSERT_EQ(change.added.size(), 1U);
  EXPECT_EQ(change.added[0].patch, PatchId{4});
  const auto waiting = patches(5, 6);
  EXPECT_EQ(change.refused, waiting);
  EXPECT_TRUE(allocator->update_by({.gone = waiting, .asked = {}}, false).refused.empty());
}

TEST(IncrementalAllocator, AShrunkenBlockGrowsBackThoughItIsNotNamedAgain) {
  const auto allocator = make_sequential_allocator(small_atlas(64, 4, 1), 32);
  const auto asked = squares(0, 32);  // twice the atlas
  allocator->update_by({.gone = {}, .asked = asked}, false);
  EXPECT_EQ(allocator->blocks()[0].block.area(), 128U);
  const auto gone = patches(8, 32);
  allocator->update_by({.gone = gone, .asked = {}}, false);
  for (const PlacedPatch& p : allocator->blocks()) EXPECT_EQ(p.block.area(), 256U);
}

TEST(IncrementalAllocator, ShrunkenBlocksGrowBackInPatchOrderWhicheverFrameShrankThem) {
  const auto allocator = make_sequential_allocator(small_atlas(64, 4, 1), 48);
  const auto asked = squares(16, 48);  // twice the atlas
  allocator->update_by({.gone = {}, .asked = asked}, false);
  const auto last = patches(40, 48);
  const auto first = squares(0, 8);
  EXPECT_TRUE(allocator->update_by({.gone = last, .asked = first}, false).refused.empty());
  const auto half = patches(24, 40);
  std::vector<PatchId> grown;
  for (const PlacedPatch& p : allocator->update_by({.gone = half, .asked = {}}, false).moved) {
    grown.push_back(p.patch);
    EXPECT_EQ(p.block.area(), 256U);
  }
  EXPECT_EQ(grown, patches(0, 4));  // up to the high-water mark
}

TEST(IncrementalAllocator, ARequestThatIsRepeatedChangesNothing) {
  const auto allocator = make_sequential_allocator(small_atlas(), 10);
  const std::vector asked{request(3, 4, 2), request(9, 9, 0, true)};
  EXPECT_EQ(allocator->update_by({.gone = {}, .asked = asked}, false).added.size(), 2U);
  const LayoutChange& change = allocator->update_by({.gone = {}, .asked = asked}, false);
  EXPECT_TRUE(change.added.empty() && change.moved.empty() && change.removed.empty());
}

}  // namespace
}  // namespace atlaswire::render
