#include "render/sas/freed_texels.h"

#include "base/random.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace atlaswire::render {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Block block(std::uint16_t x, std::uint16_t y, std::uint8_t width_log2, std::uint8_t height_log2) {
  return {.x = x, .y = y, .width_log2 = width_log2, .height_log2 = height_log2};
}

TEST(FreedTexels, NothingIsFreedBeforeItWasHeld) {
  FreedTexels freed({64, 64}, 1, 4);
  EXPECT_THAT(freed.take(), IsEmpty());
  LayoutChange change;
  change.added = {{PatchId{0}, block(0, 0, 3, 3)}};
  freed.apply(change);
  EXPECT_THAT(freed.take(), IsEmpty());
}

TEST(FreedTexels, RemovedBlocksAreTakenOnce) {
  FreedTexels freed({64, 64}, 1, 4);
  freed.apply({.added = {{PatchId{0}, block(0, 8, 4, 3)}, {PatchId{1}, block(32, 8, 2, 2)}}});
  freed.apply({.removed = {PatchId{0}, PatchId{1}}});
  EXPECT_THAT(freed.take(), ::testing::UnorderedElementsAre(TexelRect{0, 8, 16, 8}, TexelRect{32, 8, 4, 4}));
  EXPECT_THAT(freed.take(), IsEmpty());
}

TEST(FreedTexels, MovedBlocksFreeTheirOldPlaceOnly) {
  FreedTexels freed({64, 64}, 1, 4);
  freed.apply({.added = {{PatchId{2}, block(0, 0, 3, 2)}}});
  freed.apply({.moved = {{PatchId{2}, block(4, 0, 2, 2)}}});  // the right half of where it was
  EXPECT_THAT(freed.take(), ElementsAre(TexelRect{0, 0, 4, 4}));
}

TEST(FreedTexels, WhatAnotherPatchTookInTheMeantimeIsNotFree) {
  FreedTexels freed({64, 64}, 1, 4);
  freed.apply({.added = {{PatchId{0}, block(0, 0, 4, 4)}}});
  freed.apply({.added = {{PatchId{1}, block(4, 4, 2, 2)}}, .removed = {PatchId{0}}});
  std::uint64_t area = 0;
  for (const TexelRect& r : freed.take()) {
    area += r.width * r.height;
    EXPECT_TRUE(r.x + r.width <= 4 || r.x >= 8 || r.y + r.height <= 4 || r.y >= 8);
  }
  EXPECT_EQ(area, 16U * 16 - 4 * 4);
}

TEST(FreedTexels, RectanglesAreExactlyTheFreedAndUnheldTexels) {
  // Blocks of a random walk on a 32 x 32 grid of 4 x 4 blocks, against a plain texel map.
  Random random(5);
  constexpr std::uint32_t kSide = 128;
  FreedTexels freed({kSide, kSide}, 1, 400);
  std::vector<int> texels(kSide * kSide, 0);  // 0 clean, 1 held, 2 freed
  std::vector<std::int32_t> place(400, -1);
  std::vector<bool> taken(32 * 32, false);
  const auto paint = [&](std::int32_t at, int state) {
    for (std::int32_t i = 0; i < 16; ++i) {
      texels[static_cast<std::size_t>((at / 32 * 4 + i / 4) * 128 + at % 32 * 4 + i % 4)] = state;
    }
  };
  for (int frame = 0; frame < 60; ++frame) {
    LayoutChange change;
    for (std::uint32_t p = 0; p < 400; ++p) {
      if (place[p] >= 0 && random.below(5) == 0) {
        paint(place[p], 2);
        taken[static_cast<std::size_t>(place[p])] = false;
        place[p] = -1;
        change.removed.push_back(PatchId{p});
      } else if (place[p] < 0 && random.below(3) == 0) {
        const auto at = random.below(32 * 32);
        if (taken[at]) continue;
        taken[at] = true;
        place[p] = static_cast<std::int32_t>(at);
        change.added.push_back({PatchId{p}, block(static_cast<std::uint16_t>(at % 32 * 4),
                                                  static_cast<std::uint16_t>(at / 32 * 4), 2, 2)});
      }
    }
    for (std::uint32_t p = 0; p < 400; ++p) {
      if (place[p] >= 0) paint(place[p], 1);
    }
    freed.apply(change);
    if (frame % 5 != 4) continue;
    for (const TexelRect& r : freed.take()) {
      for (std::uint32_t y = r.y; y < r.y + r.height; ++y) {
        for (std::uint32_t x = r.x; x < r.x + r.width; ++x) {
          ASSERT_EQ(texels[y * kSide + x], 2) << x << ", " << y;
          texels[y * kSide + x] = 0;
        }
      }
    }
    EXPECT_EQ(std::ranges::count(texels, 2), 0) << "frame " << frame;
  }
}

}  // namespace
}  // namespace atlaswire::render
