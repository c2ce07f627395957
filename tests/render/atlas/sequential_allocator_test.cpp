#include "base/program.h"
#include "render/atlas/layout_hash.h"
#include "tests/render/atlas/layout_checker.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace atlaswire::render {
namespace {

/// One size for a run of patches.
std::vector<BlockRequest> uniform(std::uint32_t first, std::uint32_t count, std::uint32_t w,
                                  std::uint32_t h) {
  std::vector<BlockRequest> out;
  for (std::uint32_t i = 0; i < count; ++i) out.push_back(request(first + i, w, h));
  return out;
}

struct Load {
  AllocatorSettings settings;
  std::uint32_t patches;
  double churn;
  double visible;
  std::uint32_t largest_log2;
  int frames;
};

class AllocatorDrift : public testing::TestWithParam<Load> {};

TEST_P(AllocatorDrift, KeepsEveryPromiseInEveryFrame) {
  const Load& run = GetParam();
  const auto allocator = make_sequential_allocator(run.settings, run.patches);
  LayoutChecker checker(run.settings);
  DriftingScene scene(7, run.patches, run.settings);
  for (int frame = 0; frame < run.frames; ++frame) {
    const auto& visible = scene.step(frame == 0 ? 1.0 : run.churn, run.visible, run.largest_log2);
    const bool may_reset = frame % 5 == 0;
    const bool wanted = allocator->wants_reset();
    const LayoutChange& change = allocator->update(visible, may_reset);
    EXPECT_EQ(change.reset, may_reset && wanted);
    ASSERT_EQ(checker.check(*allocator, visible, change), "") << "frame " << frame;
  }
  allocator->update({}, false);
  EXPECT_EQ(allocator->usage().free, run.settings.atlas.area());
}

INSTANTIATE_TEST_SUITE_P(
    Loads, AllocatorDrift,
    testing::Values(Load{small_atlas(), 600, 0.05, 0.4, 4, 2000},         // comfortable
                    Load{small_atlas(), 3000, 0.05, 0.5, 4, 300},         // far too much
                    Load{small_atlas(), 400, 1.0, 0.5, 5, 300},           // all new, every frame
                    Load{small_atlas(32, 5, 1), 40, 0.2, 0.5, 5, 2000},   // one superblock
                    Load{small_atlas(64, 4, 0), 3000, 0.1, 0.7, 1, 200},  // 1 x 1 blocks
                    Load{small_atlas(64, 3, 3), 100, 0.3, 0.8, 3, 500},   // a single legal size
                    Load{{.atlas = {512, 64}, .superblock_log2 = 6}, 300, 0.1, 0.5, 6, 500}));

TEST(SequentialAllocator, IsDeterministic) {
  const auto settings = small_atlas();
  const auto a = make_sequential_allocator(settings, 800);
  const auto b = make_sequential_allocator(settings, 800);
  DriftingScene scene(3, 800, settings);
  for (int frame = 0; frame < 200; ++frame) {
    const auto& visible = scene.step(0.1, 0.6, 4);
    a->update(visible, frame % 5 == 0);
    b->update(visible, frame % 5 == 0);
    const auto left = a->blocks();
    const auto right = b->blocks();
    ASSERT_TRUE(std::ranges::equal(
        left, right, [](const auto& l, const auto& r) { return l.patch == r.patch && l.block == r.block; }));
  }
}

TEST(SequentialAllocator, LaysOutAsReceiversDo) {
  // Layouts are part of the protocol: another order of slots would part both ends.
  const auto layouts = [](const AllocatorSettings& settings, std::uint32_t patches) {
    const auto allocator = make_sequential_allocator(settings, patches);
    DriftingScene scene(29, patches, settings);
    LayoutHash hash;
    for (int frame = 0; frame < 400; ++frame) {
      const double visible = frame / 40 % 2 == 0 ? 0.6 : 0.3;
      hash.follow(allocator->update(scene.step(frame == 0 ? 1.0 : 0.03, visible, 4), frame % 7 == 0));
    }
    return hash.hash().value();
  };
  EXPECT_EQ(layouts(small_atlas(), 600), 0xBAC605E8U);
  EXPECT_EQ(layouts(small_atlas(128), 300), 0xD71468E7U);       // shrinks and grows blocks
  EXPECT_EQ(layouts(small_atlas(64, 4, 3), 300), 0x3BC8C4D9U);  // refuses
}

TEST(SequentialAllocator, GivesEveryPatchItsSizeWhereMemorySuffices) {
  const auto settings = small_atlas();
  const auto allocator = make_sequential_allocator(settings, 500);
  DriftingScene scene(11, 500, settings);
  for (int frame = 0; frame < 500; ++frame) {
    const auto& visible = scene.step(0.05, 0.3, 3);
    const auto& change = allocator->update(visible, false);
    ASSERT_TRUE(change.refused.empty());
    const auto blocks = allocator->blocks();
    ASSERT_EQ(blocks.size(), visible.size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      ASSERT_EQ(blocks[i].block.width_log2, visible[i].width_log2);
      ASSERT_EQ(blocks[i].block.height_log2, visible[i].height_log2);
    }
  }
}

TEST(SequentialAllocator, FillsTheAtlasToItsLastTexel) {
  const auto settings = small_atlas(64, 4, 1);
  const auto allocator = make_sequential_allocator(settings, 1024);
  const auto visible = uniform(0, 1024, 1, 1);
  EXPECT_TRUE(allocator->update(visible, false).refused.empty());
  EXPECT_EQ(allocator->usage().allocated, settings.atlas.area());
}

TEST(SequentialAllocator, RefusesOnlyWhatSmallestBlocksCannotHold) {
  const auto settings = small_atlas(64, 4, 1);
  const auto allocator = make_sequential_allocator(settings, 1100);
  const auto visible = uniform(0, 1100, 2, 2);
  const auto& change = allocator->update(visible, false);
  EXPECT_EQ(change.refused.size(), 1100U - 1024U);
  EXPECT_FALSE(allocator->wants_reset());  // no reset can serve more
}

TEST(SequentialAllocator, ShrinksLargeBlocksBeforeItRefuses) {
  const auto settings = small_atlas(64, 4, 1);
  const auto allocator = make_sequential_allocator(settings, 200);
  auto visible = uniform(0, 100, 1, 1);
  const auto large = uniform(100, 100, 4, 4);
  visible.insert(visible.end(), large.begin(), large.end());
  const auto& change = allocator->update(visible, false);
  EXPECT_TRUE(change.refused.empty());
  LayoutChecker checker(settings);
  EXPECT_EQ(checker.check(*allocator, visible, change), "");
  EXPECT_GT(allocator->usage().allocated, settings.atlas.area() * 8 / 10);
}

TEST(SequentialAllocator, GrowsAShrunkenBlockBackOnceThereIsRoom) {
  const auto settings = small_atlas(64, 4, 1);
  const auto allocator = make_sequential_allocator(settings, 40);
  allocator->update(uniform(0, 32, 4, 4), false);  // twice the atlas
  EXPECT_EQ(allocator->blocks()[0].block.area(), 128U);
  const auto half = uniform(0, 8, 4, 4);
  allocator->update(half, false);
  allocator->update(half, false);
  for (const PlacedPatch& p : allocator->blocks()) EXPECT_EQ(p.block.area(), 256U);
}

TEST(SequentialAllocator, MirroringAPatchKeepsItsPlace) {
  const auto allocator = make_sequential_allocator(small_atlas(), 10);
  allocator->update(std::vector{request(4, 3, 2, false)}, false);
  const Block before = allocator->blocks()[0].block;
  const auto& change = allocator->update(std::vector{request(4, 3, 2, true)}, false);
  ASSERT_EQ(change.moved.size(), 1U);
  EXPECT_TRUE(change.moved[0].block.transposed);
  EXPECT_EQ(change.moved[0].block.x, before.x);
  EXPECT_EQ(change.moved[0].block.y, before.y);
}

TEST(SequentialAllocator, ClampsRequestsToLegalBlocks) {
  const auto allocator = make_sequential_allocator(small_atlas(256, 5, 1), 3);
  allocator->update(std::vector{request(0, 0, 0), request(1, 9, 9), request(2, 9, 0)}, false);
  const auto blocks = allocator->blocks();
  EXPECT_EQ(blocks[0].block.area(), 4U);
  EXPECT_EQ(blocks[1].block.area(), 1024U);
  EXPECT_EQ(blocks[2].block.width_log2, 5U);
  EXPECT_EQ(blocks[2].block.height_log2, 1U);
}

TEST(SequentialAllocator, ResetsOnlyWhenAllowedAndOnlyWhenItHelps) {
  // Every other block of a full atlas goes: memory is high, half of it fragmented on stacks.
  const auto settings = small_atlas(64, 4, 1);
  const auto allocator = make_sequential_allocator(settings, 1024);
  LayoutChecker checker(settings);
  const auto full = uniform(0, 1024, 1, 1);
  ASSERT_EQ(checker.check(*allocator, full, allocator->update(full, true)), "");
  EXPECT_FALSE(allocator->wants_reset());  // full, but packed perfectly
  std::vector<BlockRequest> half;
  for (std::uint32_t i = 0; i < 1024; i += 2) half.push_back(request(i, 1, 1));
  ASSERT_EQ(checker.check(*allocator, half, allocator->update(half, false)), "");
  EXPECT_EQ(allocator->usage().free, 0U);
  EXPECT_TRUE(allocator->wants_reset());
  const auto& still = allocator->update(half, false);
  EXPECT_FALSE(still.reset);
  EXPECT_TRUE(still.moved.empty());
  const auto& change = allocator->update(half, true);
  EXPECT_TRUE(change.reset);
  ASSERT_EQ(checker.check(*allocator, half, change), "");
  EXPECT_EQ(allocator->usage().free, settings.atlas.area() / 2);
  EXPECT_FALSE(allocator->wants_reset());
}

TEST(SequentialAllocator, ALastingOverloadDoesNotResetAgainAndAgain) {
  const auto settings = small_atlas(64, 4, 1);
  const auto allocator = make_sequential_allocator(settings, 64);
  const auto visible = uniform(0, 64, 4, 3);
  int resets = 0;
  for (int frame = 0; frame < 100; ++frame) resets += allocator->update(visible, true).reset ? 1 : 0;
  EXPECT_LE(resets, 1);
}

TEST(SequentialAllocator, GivesUpResettingWhenPackingAnewLeavesTheSameGap) {
  // 56 of 64 texels are wanted, but five 8 x 1 leave no 4 x 4.
  const auto allocator = make_sequential_allocator(small_atlas(8, 3, 0), 6);
  auto visible = uniform(0, 5, 3, 0);
  visible.push_back(request(5, 2, 2));
  int resets = 0;
  for (int frame = 0; frame < 20; ++frame) resets += allocator->update(visible, true).reset ? 1 : 0;
  EXPECT_EQ(resets, 1);
  EXPECT_EQ(allocator->blocks()[5].block.area(), 8U);
}

TEST(SequentialAllocator, ShrunkenBlocksStandStillWhileNothingChanges) {
  const auto allocator = make_sequential_allocator(small_atlas(64, 4, 1), 100);
  auto visible = uniform(0, 70, 4, 3);
  for (const auto& r : uniform(70, 30, 3, 1)) visible.push_back(r);
  for (int frame = 0; frame < 5; ++frame) allocator->update(visible, false);
  for (int frame = 0; frame < 20; ++frame) {
    const auto& change = allocator->update(visible, false);
    EXPECT_TRUE(change.added.empty() && change.moved.empty() && change.removed.empty());
  }
}

TEST(SequentialAllocator, APatchThatLosesItsBlockIsBothRemovedAndRefused) {
  const auto settings = small_atlas(4, 2, 1);  // four smallest blocks
  const auto allocator = make_sequential_allocator(settings, 10);
  LayoutChecker checker(settings);
  const auto before = uniform(0, 4, 1, 1);
  ASSERT_EQ(checker.check(*allocator, before, allocator->update(before, false)), "");
  std::vector<BlockRequest> after{request(0, 2, 1), request(1, 1, 1), request(2, 1, 1)};
  for (const auto& r : uniform(4, 4, 1, 1)) after.push_back(r);
  const auto& change = allocator->update(after, false);
  ASSERT_EQ(checker.check(*allocator, after, change), "");
  EXPECT_EQ(change.removed, (std::vector{PatchId{0}, PatchId{3}}));
  EXPECT_EQ(change.refused, (std::vector{PatchId{0}, PatchId{6}, PatchId{7}}));
}

TEST(SequentialAllocator, NewMemoryGoesToTheLargestFirstAndFillsOneSuperblockPerWidth) {
  const auto allocator = make_sequential_allocator(small_atlas(64, 4, 1), 40);
  // 3 of 8 x 8 leave a 8 x 8 tail, that 2 of 8 x 2 top up in the next frame.
  allocator->update(uniform(0, 3, 3, 3), false);
  EXPECT_EQ(allocator->usage().partial_tail, 64U);
  auto visible = uniform(0, 3, 3, 3);
  for (const auto& r : uniform(3, 2, 3, 1)) visible.push_back(r);
  allocator->update(visible, false);
  const auto u = allocator->usage();
  EXPECT_EQ(u.partial_tail, 0U);
  EXPECT_EQ(u.on_stacks, 32U);
  EXPECT_EQ(u.free, 64U * 64U - 256U);
}

TEST(SequentialAllocator, EmptySetsChangeNothing) {
  const auto allocator = make_sequential_allocator(small_atlas(), 0);
  const auto& change = allocator->update({}, true);
  EXPECT_FALSE(change.reset);
  EXPECT_TRUE(change.added.empty() && change.removed.empty() && change.refused.empty());
  EXPECT_FALSE(allocator->wants_reset());
}

TEST(SequentialAllocator, RejectsAnAtlasThatSuperblocksDoNotTile) {
  EXPECT_THROW(make_sequential_allocator({.atlas = {100, 64}}, 1), ProgramError);
  EXPECT_THROW(make_sequential_allocator({.atlas = {0, 0}}, 1), ProgramError);
  EXPECT_THROW(make_sequential_allocator({.atlas = {64, 64}, .superblock_log2 = 2, .min_block_log2 = 3}, 1),
               ProgramError);
}

}  // namespace
}  // namespace atlaswire::render
