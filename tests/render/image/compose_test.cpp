#include "render/image/compose.h"

#include <gtest/gtest.h>

namespace atlaswire::render {
namespace {

constexpr Rgba8 kRed{255, 0, 0, 255};
constexpr Rgba8 kBlue{0, 0, 255, 255};
constexpr Rgba8 kWhite{255, 255, 255, 255};
constexpr Rgba8 kBlack{0, 0, 0, 255};

std::size_t count(const Picture& picture, Rgba8 colour) {
  std::size_t found = 0;
  for (std::uint32_t y = 0; y < picture.extent.height; ++y) {
    for (std::uint32_t x = 0; x < picture.extent.width; ++x) found += picture.at(x, y) == colour ? 1 : 0;
  }
  return found;
}

TEST(SideBySide, PlacesPanelsWithGapsAndTopsAligned) {
  const Picture a({10, 20}, kRed);
  const Picture b({30, 5}, kBlue);
  const Panel panels[] = {{&a, ""}, {&b, ""}};
  const Picture row = side_by_side(panels, {.gap = 4, .background = kBlack});
  EXPECT_EQ(row.extent, (Extent2D{4 + 10 + 4 + 30 + 4, 4 + 20 + 4}));
  EXPECT_EQ(row.at(4, 4), kRed);
  EXPECT_EQ(row.at(13, 23), kRed);
  EXPECT_EQ(row.at(3, 4), kBlack);
  EXPECT_EQ(row.at(14, 4), kBlack);
  EXPECT_EQ(row.at(18, 4), kBlue);
  EXPECT_EQ(row.at(18, 9), kBlack);
  EXPECT_EQ(count(row, kRed), 200U);
  EXPECT_EQ(count(row, kBlue), 150U);
}

TEST(SideBySide, WritesLabelsAboveAndCutsThemAtTheirPanel) {
  const Picture a({40, 4}, kBlue);
  const Panel panels[] = {{&a, "ABCDEFGHIJKL"}};
  const Picture row = side_by_side(panels, {.gap = 2, .label_scale = 1, .background = kBlack, .ink = kWhite});
  EXPECT_EQ(row.extent, (Extent2D{44, 2 + 7 + 2 + 4 + 2}));
  Picture expected({44, 17}, kBlack);
  draw_text(expected, 2, 2, "ABCDEF", 1, kWhite);
  EXPECT_EQ(count(row, kWhite), count(expected, kWhite));
  EXPECT_EQ(row.at(2, 11), kBlue);
}

TEST(SideBySide, ShowsTheBackgroundThroughHoles) {
  const Picture hole({2, 2}, {200, 200, 200, 0});
  const Panel panels[] = {{&hole, ""}};
  EXPECT_EQ(side_by_side(panels, {.gap = 1, .background = kBlue}).at(1, 1), kBlue);
  EXPECT_EQ(side_by_side({}, {.gap = 3}).extent, (Extent2D{3, 6}));
}

TEST(DrawText, DrawsScaledGlyphsAndClips) {
  Picture one({5, 7}, kBlack);
  draw_text(one, 0, 0, "I", 1, kWhite);
  EXPECT_EQ(count(one, kWhite), 11U);
  EXPECT_EQ(one.at(2, 3), kWhite);
  EXPECT_EQ(one.at(0, 3), kBlack);
  Picture three({15, 21}, kBlack);
  draw_text(three, 0, 0, "i", 3, kWhite);
  EXPECT_EQ(count(three, kWhite), 99U);
  Picture clipped({3, 3}, kBlack);
  draw_text(clipped, 1, 1, "MSSIM 0.95", 2, kWhite);
  draw_text(clipped, 50, 50, "X", 2, kWhite);
  EXPECT_EQ(clipped.extent, (Extent2D{3, 3}));
}

TEST(DrawText, ShowsABoxForWhatTheFontLacks) {
  Picture box({5, 7}, kBlack);
  draw_text(box, 0, 0, "~", 1, kWhite);
  EXPECT_EQ(count(box, kWhite), 20U);
}

TEST(ResizedNearest, RepeatsAndDropsPixels) {
  Picture two({2, 1}, kRed);
  two.set(1, 0, kBlue);
  const Picture large = resized_nearest(two, {6, 2});
  EXPECT_EQ(large.at(2, 1), kRed);
  EXPECT_EQ(large.at(3, 0), kBlue);
  EXPECT_EQ(resized_nearest(large, {2, 1}), two);
}

TEST(HeatDifference, RunsFromBlackToWhite) {
  const Picture a({1, 1}, {10, 10, 10, 255});
  EXPECT_EQ(heat_difference(a, a).at(0, 0), kBlack);
  const Picture third({1, 1}, {10, 95, 10, 255});
  EXPECT_EQ(heat_difference(a, third, 1).at(0, 0), kRed);
  const Picture far({1, 1}, {10, 10, 180, 255});
  EXPECT_EQ(heat_difference(a, far, 1).at(0, 0), (Rgba8{255, 255, 0, 255}));
  EXPECT_EQ(heat_difference(a, far, 10).at(0, 0), kWhite);
}

}  // namespace
}  // namespace atlaswire::render
