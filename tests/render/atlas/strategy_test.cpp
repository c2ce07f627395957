#include "render/atlas/strategy.h"

#include "base/program.h"
#include "tests/render/atlas/layout_checker.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace atlaswire::render {
namespace {

const AllocatorSettings kSettings{.atlas = {256, 256}, .superblock_log2 = 5};

class EveryStrategy : public testing::TestWithParam<Strategy> {};

TEST_P(EveryStrategy, KeepsEveryPromiseInEveryFrame) {
  const auto allocator = make_allocator(GetParam(), kSettings, 900);
  LayoutChecker checker(kSettings);
  DriftingScene scene(5, 900, kSettings);
  for (int frame = 0; frame < 800; ++frame) {
    const auto& visible = scene.step(frame == 0 ? 1.0 : 0.05, 0.3 + 0.3 * (frame / 100 % 2), 4);
    const bool may_reset = frame % 5 == 0;
    const LayoutChange& change = allocator->update(visible, may_reset);
    EXPECT_TRUE(may_reset || !change.reset || GetParam() == Strategy::kRepack);
    ASSERT_EQ(checker.check(*allocator, visible, change), "") << "frame " << frame;
  }
  allocator->update({}, false);
  EXPECT_EQ(allocator->usage().free, kSettings.atlas.area());
}

TEST_P(EveryStrategy, RejectsAnAtlasThatSuperblocksDoNotTile) {
  EXPECT_THROW(make_allocator(GetParam(), {.atlas = {100, 64}}, 1), ProgramError);
}

INSTANTIATE_TEST_SUITE_P(All, EveryStrategy, testing::ValuesIn(strategies().begin(), strategies().end()),
                         [](const auto& strategy) { return std::string(name_of(strategy.param)); });

/// Half of the blocks of two superblocks go; then as many are asked for again.
AtlasUsage after_half_is_freed(AtlasAllocator& allocator) {
  std::vector<BlockRequest> all;
  std::vector<BlockRequest> half;
  for (std::uint32_t i = 0; i < 128; ++i) {
    all.push_back(request(i, 2, 2));
    if (i % 2 == 0) half.push_back(request(i, 2, 2));
  }
  allocator.update(all, false);
  allocator.update(half, false);
  return allocator.usage();
}

TEST(Strategies, FreedBlocksAreOnStacksOrInaccessible) {
  const auto s1 = make_allocator(Strategy::kS1, kSettings, 200);
  const AtlasUsage with_stacks = after_half_is_freed(*s1);
  EXPECT_EQ(with_stacks.on_stacks, 64U * 16U);
  EXPECT_EQ(with_stacks.inaccessible, 0U);
  const auto s2 = make_allocator(Strategy::kS2, kSettings, 200);
  const AtlasUsage without = after_half_is_freed(*s2);
  EXPECT_EQ(without.on_stacks, 0U);
  EXPECT_EQ(without.inaccessible, 64U * 16U);
  EXPECT_EQ(without.allocated, 64U * 16U);
}

TEST(Strategies, WithoutColumnsEveryLevelOpensItsOwnSuperblock) {
  const std::vector visible{request(0, 3, 3), request(1, 3, 2), request(2, 3, 1)};
  const std::uint64_t superblock = 1024;
  const auto s0 = make_allocator(Strategy::kS0, kSettings, 3);
  s0->update(visible, false);
  EXPECT_EQ(s0->usage().free, kSettings.atlas.area() - superblock);
  const auto s1 = make_allocator(Strategy::kS1, kSettings, 3);
  s1->update(visible, false);
  EXPECT_EQ(s1->usage().free, kSettings.atlas.area() - 3 * superblock);
}

TEST(Strategies, S3NeverResets) {
  const auto s3 = make_allocator(Strategy::kS3, kSettings, 4000);
  DriftingScene scene(1, 4000, kSettings);
  for (int frame = 0; frame < 60; ++frame) {
    EXPECT_FALSE(s3->update(scene.step(frame == 0 ? 1.0 : 0.2, 0.5, 4), true).reset);
    EXPECT_FALSE(s3->wants_reset());
  }
}

TEST(Strategies, RepackingDependsOnTheFrameAloneAndMovesBlocks) {
  const auto repack = make_allocator(Strategy::kRepack, kSettings, 900);
  const auto stable = make_allocator(Strategy::kQuadtree, kSettings, 900);
  DriftingScene scene(3, 900, kSettings);
  std::size_t moved = 0;
  std::size_t moved_by_need = 0;
  for (int frame = 0; frame < 50; ++frame) {
    const auto& visible = scene.step(frame == 0 ? 1.0 : 0.05, 0.3, 4);
    moved += repack->update(visible, false).moved.size();
    moved_by_need += stable->update(visible, false).moved.size();
    const auto fresh = make_allocator(Strategy::kRepack, kSettings, 900);
    fresh->update(visible, false);
    ASSERT_TRUE(std::ranges::equal(repack->blocks(), fresh->blocks(), [](const auto& a, const auto& b) {
      return a.patch == b.patch && a.block == b.block;
    })) << frame;
    EXPECT_FALSE(repack->wants_reset());
  }
  EXPECT_GT(moved, 3 * moved_by_need);
}

TEST(Strategies, AreFoundByTheirNames) {
  for (const Strategy strategy : strategies()) EXPECT_EQ(find_strategy(name_of(strategy)), strategy);
  EXPECT_FALSE(find_strategy("S4"));
}

TEST(Strategies, AQuadtreeMergesWhatIsFree) {
  const auto tree = make_allocator(Strategy::kQuadtree, kSettings, 200);
  after_half_is_freed(*tree);
  std::vector<BlockRequest> few{request(0, 2, 2)};
  tree->update(few, false);
  EXPECT_EQ(tree->usage().free, kSettings.atlas.area() - 1024);
  few.push_back(request(1, 4, 4));  // fits beside it, in the same square
  tree->update(few, false);
  EXPECT_EQ(tree->usage().free, kSettings.atlas.area() - 1024);
}

}  // namespace
}  // namespace atlaswire::render
