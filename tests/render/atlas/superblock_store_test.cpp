#include "render/atlas/superblock_store.h"

#include <gtest/gtest.h>

namespace atlaswire::render {
namespace {

Block block_at(TexelPosition at, Level level) {
  return {at.x, at.y, level.width_log2, level.height_log2, false};
}

std::uint64_t total(const AtlasUsage& u) {
  return u.allocated + u.partial_tail + u.on_stacks + u.inaccessible + u.free;
}

/// The worked example of [SAS] fig. 8 and table 1: superblocks of 8, width 4, three 4 x 4 blocks taken.
TEST(SuperblockStore, PacksTheExampleOfThePaper) {
  SuperblockStore store({32, 8}, 3, 0);
  const Level four{2, 2};
  const Level two{2, 1};
  const Level one{2, 0};
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(store.bump(four));
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(store.bump(four));  // b1 ends S1, b2 opens S2
  EXPECT_EQ(store.free_superblocks(), 2U);
  for (int i = 0; i < 6; ++i) ASSERT_TRUE(store.bump(two));  // b3..b8 fill S2
  EXPECT_EQ(store.free_superblocks(), 2U);
  const auto b9 = store.bump(two);  // S3
  ASSERT_TRUE(b9);
  EXPECT_EQ(b9->x, 16);
  EXPECT_EQ(b9->y, 0);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(store.bump(one));  // b10..b12
  store.align_tail(2);
  EXPECT_EQ(store.stacked(one), 1U);  // b13
  EXPECT_EQ(store.stacked(two), 1U);  // b14
  EXPECT_EQ(store.usage().partial_tail, 2U * 16U);
  EXPECT_EQ(total(store.usage()), 256U);
}

TEST(SuperblockStore, GivesAnEmptiedSuperblockBackAndForgetsItsStackEntries) {
  SuperblockStore store({16, 8}, 3, 1);
  const Level level{2, 1};
  std::vector<Block> blocks;
  for (int i = 0; i < 8; ++i) blocks.push_back(block_at(*store.bump(level), level));
  EXPECT_EQ(store.free_superblocks(), 1U);
  for (const Block& b : blocks) store.release(b);
  EXPECT_EQ(store.free_superblocks(), 2U);
  EXPECT_EQ(store.stacked(level), 0U);
  EXPECT_FALSE(store.pop(level));
  const Level whole{3, 3};
  ASSERT_TRUE(store.bump(whole));
  ASSERT_TRUE(store.bump(whole));
  EXPECT_EQ(store.allocated(), 128U);
}

TEST(SuperblockStore, SplitsTheSmallestBlockThatHolds) {
  SuperblockStore store({16, 8}, 3, 1);
  const auto small = store.bump({2, 2});
  ASSERT_TRUE(small);
  store.align_tail(2);
  const auto at = store.take_best_fit({1, 1});  // from the width-4 tail, not from the free superblock
  ASSERT_TRUE(at);
  EXPECT_EQ(store.free_superblocks(), 1U);
  EXPECT_EQ(store.stacked({2, 1}), 1U);
  EXPECT_EQ(store.stacked({1, 1}), 1U);
  EXPECT_EQ(total(store.usage()), 128U);
}

TEST(SuperblockStore, HandsOutEveryTexelAsSmallestBlocks) {
  SuperblockStore store({16, 16}, 3, 0);
  ASSERT_TRUE(store.bump({3, 1}));
  store.align_tail(3);
  int count = 0;
  while (store.take_best_fit({0, 0})) ++count;
  EXPECT_EQ(count, 256 - 16);
  EXPECT_EQ(store.allocated(), store.area());
}

TEST(SuperblockStore, HasNoRoomForMoreThanItsArea) {
  SuperblockStore store({8, 8}, 3, 3);
  ASSERT_TRUE(store.bump({3, 3}));
  EXPECT_FALSE(store.bump({3, 3}));
  EXPECT_FALSE(store.pop({3, 3}));
  EXPECT_FALSE(store.take_best_fit({3, 3}));
}

}  // namespace
}  // namespace atlaswire::render
