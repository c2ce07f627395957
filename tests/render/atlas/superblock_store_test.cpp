#include "render/atlas/superblock_store.h"

#include <gtest/gtest.h>

namespace atlaswire::render {
namespace {

struct Wish {
  Level level;
  std::uint32_t count;
};

/// One frame's way through a store, with every slot placed.
struct Frame {
  SuperblockStore& store;
  Provision provision{};

  std::vector<Block> take(std::initializer_list<Wish> wishes, bool may_shrink = true) {
    PerLevel requested{};
    for (const Wish& w : wishes) requested[store.numbers().number(w.level)] += w.count;
    store.provision(requested, 2 * store.numbers().max_log2(), may_shrink, provision);
    std::vector<Block> blocks;
    for (const Wish& w : wishes) {
      for (std::uint32_t slot = 0; slot < w.count; ++slot) {
        const auto placed = store.place(provision, w.level, slot);
        if (!placed) continue;
        blocks.push_back(
            {placed->at.x, placed->at.y, placed->level.width_log2, placed->level.height_log2, false});
      }
    }
    store.settle();
    return blocks;
  }
};

std::uint64_t total(const AtlasUsage& u) {
  return u.allocated + u.partial_tail + u.on_stacks + u.inaccessible + u.free;
}

constexpr Level kFour{2, 2};
constexpr Level kTwo{2, 1};
constexpr Level kOne{2, 0};

/// The worked example of [SAS] fig. 8 and table 1, less its stacks: superblocks of 8, width 4, three 4 x 4
/// blocks taken; 2, 9 and 3 blocks required.
TEST(SuperblockStore, PacksTheExampleOfThePaper) {
  SuperblockStore store({32, 8}, 3, 0);
  Frame{store}.take({{kFour, 3}});
  EXPECT_EQ(store.free_superblocks(), 3U);
  EXPECT_EQ(store.usage().partial_tail, 16U);

  Frame frame{store};
  const auto blocks = frame.take({{kFour, 2}, {kTwo, 9 - 2}, {kOne, 3}});
  ASSERT_EQ(blocks.size(), 12U);
  EXPECT_EQ(blocks[0], (Block{4, 4, 2, 2, false}));   // b1 ends S1
  EXPECT_EQ(blocks[1], (Block{8, 0, 2, 2, false}));   // b2 opens S2
  EXPECT_EQ(blocks[2], (Block{8, 4, 2, 1, false}));   // b3..b8 fill S2
  EXPECT_EQ(blocks[7], (Block{12, 6, 2, 1, false}));  // b8
  EXPECT_EQ(blocks[8], (Block{16, 0, 2, 1, false}));  // b9 opens S3
  EXPECT_EQ(blocks[9], (Block{16, 2, 2, 0, false}));  // b10..b12
  EXPECT_EQ(blocks[11], (Block{16, 4, 2, 0, false}));
  EXPECT_EQ(store.free_superblocks(), 1U);
  EXPECT_EQ(store.stacked(kOne), 1U);               // b13
  EXPECT_EQ(store.stacked(kTwo), 1U);               // b14
  EXPECT_EQ(store.usage().partial_tail, 2U * 16U);  // room for two of height 4
  EXPECT_EQ(total(store.usage()), 256U);
}

TEST(SuperblockStore, DrawsFromItsStackBeforeItOpensMemory) {
  SuperblockStore store({32, 8}, 3, 0);
  const auto blocks = Frame{store}.take({{kTwo, 8}});
  store.release(std::vector{blocks[1], blocks[4], blocks[6]});
  EXPECT_EQ(store.stacked(kTwo), 3U);
  const auto again = Frame{store}.take({{kTwo, 4}});
  EXPECT_EQ(again[0], blocks[6]);  // the newest first
  EXPECT_EQ(again[1], blocks[4]);
  EXPECT_EQ(again[2], blocks[1]);
  EXPECT_EQ(again[3].x, 8);
  EXPECT_EQ(store.stacked(kTwo), 1U);  // so that the tail starts at a multiple of its width
}

TEST(SuperblockStore, GivesAnEmptiedSuperblockBackAndForgetsItsStackEntries) {
  SuperblockStore store({16, 8}, 3, 1);
  const auto blocks = Frame{store}.take({{kTwo, 8}});
  EXPECT_EQ(store.free_superblocks(), 1U);
  store.release(std::span(blocks).first(5));
  EXPECT_EQ(store.stacked(kTwo), 5U);
  EXPECT_EQ(store.free_superblocks(), 1U);
  store.release(std::span(blocks).subspan(5));
  EXPECT_EQ(store.free_superblocks(), 2U);
  EXPECT_EQ(store.stacked(kTwo), 0U);
  EXPECT_EQ(Frame{store}.take({{{3, 3}, 2}}).size(), 2U);
  EXPECT_EQ(store.allocated(), 128U);
}

TEST(SuperblockStore, SplitsTheSmallestBlockThatHolds) {
  SuperblockStore store({16, 8}, 3, 1);
  Frame{store}.take({{kFour, 1}, {{3, 3}, 1}});
  ASSERT_EQ(store.free_superblocks(), 0U);
  const auto blocks = Frame{store}.take({{{1, 1}, 1}});  // from the width-4 tail
  ASSERT_EQ(blocks.size(), 1U);
  EXPECT_EQ(store.stacked({2, 1}), 1U);
  EXPECT_EQ(store.stacked({1, 1}), 1U);
  EXPECT_EQ(store.usage().partial_tail, 2U * 16U);
  EXPECT_EQ(total(store.usage()), 128U);
}

TEST(SuperblockStore, HandsOutEveryTexelAsSmallestBlocks) {
  SuperblockStore store({16, 16}, 3, 0);
  Frame{store}.take({{{3, 1}, 1}});
  EXPECT_EQ(Frame{store}.take({{{0, 0}, 256}}).size(), 256U - 16U);
  EXPECT_EQ(store.allocated(), store.area());
}

TEST(SuperblockStore, HasNoRoomForMoreThanItsArea) {
  SuperblockStore store({8, 8}, 3, 3);
  EXPECT_EQ(Frame{store}.take({{{3, 3}, 2}}).size(), 1U);
  EXPECT_EQ(Frame{store}.take({{{3, 3}, 1}}).size(), 0U);
}

TEST(SuperblockStore, ShrinksWhatDoesNotFitOnlyWhereItMay) {
  SuperblockStore store({8, 8}, 3, 1);
  Frame{store}.take({{kTwo, 1}});  // all else is a tail of width 4
  EXPECT_TRUE(Frame{store}.take({{{3, 2}, 1}}, false).empty());
  const auto blocks = Frame{store}.take({{{3, 2}, 1}}, true);
  ASSERT_EQ(blocks.size(), 1U);
  EXPECT_EQ(blocks[0].area(), 16U);
  EXPECT_EQ(total(store.usage()), 64U);
}

TEST(SuperblockStore, DeferredBlocksAreFreeOnlyFromTheNextReleaseOn) {
  SuperblockStore store({8, 8}, 3, 2);
  const auto blocks = Frame{store}.take({{kFour, 4}});
  store.defer(blocks[2]);
  EXPECT_EQ(store.usage().on_stacks, 16U);
  EXPECT_EQ(total(store.usage()), 64U);
  EXPECT_TRUE(Frame{store}.take({{kFour, 1}}).empty());
  store.release({});
  EXPECT_EQ(Frame{store}.take({{kFour, 1}}), std::vector{blocks[2]});
}

}  // namespace
}  // namespace atlaswire::render
