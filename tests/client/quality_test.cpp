#include "client/quality.h"

#include <gtest/gtest.h>

namespace atlaswire::client {
namespace {

using render::Picture;

Picture checkered(Extent2D extent) {
  Picture p(extent);
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 0; x < extent.width; ++x) {
      if (((x / 4) + (y / 4)) % 2 == 0) p.set(x, y, {200, 180, 90, 255});
    }
  }
  return p;
}

TEST(Quality, EqualPicturesAreAsGoodAsItGets) {
  const Picture p = checkered({32, 24});
  const Quality q = compare(p, p);
  EXPECT_NEAR(q.mssim, 1, 1e-6);
  EXPECT_DOUBLE_EQ(q.psnr, 99);
  EXPECT_DOUBLE_EQ(q.coverage, 1);
}

TEST(Quality, CoverageCountsHolesWhereTheTruthHasGeometry) {
  Picture truth({20, 20}, {50, 50, 50, 0});
  Picture view({20, 20}, {50, 50, 50, 0});
  for (std::uint32_t x = 0; x < 20; ++x) truth.set(x, 3, {50, 50, 50, 255});
  for (std::uint32_t x = 0; x < 15; ++x) view.set(x, 3, {50, 50, 50, 255});
  view.set(4, 10, {50, 50, 50, 255});  // more than the truth is no hole
  EXPECT_DOUBLE_EQ(compare(truth, view).coverage, 0.75);
  EXPECT_DOUBLE_EQ(compare(Picture({20, 20}, {0, 0, 0, 0}), view).coverage, 1);
}

TEST(Quality, SummaryAveragesAndKeepsTheLowest) {
  const std::vector<Quality> all{{.mssim = 0.9, .psnr = 30, .coverage = 1},
                                 {.mssim = 0.7, .psnr = 20, .coverage = 0.5}};
  const QualitySummary s = summarize(all);
  EXPECT_EQ(s.count, 2U);
  EXPECT_DOUBLE_EQ(s.mssim, 0.8);
  EXPECT_DOUBLE_EQ(s.mssim_lowest, 0.7);
  EXPECT_DOUBLE_EQ(s.psnr, 25);
  EXPECT_DOUBLE_EQ(s.coverage, 0.75);
  EXPECT_EQ(summarize({}).count, 0U);
}

TEST(Quality, NotableAreWorstMedianAndLast) {
  const std::vector<Quality> all{
      {.mssim = 0.9}, {.mssim = 0.2}, {.mssim = 0.8}, {.mssim = 0.7}, {.mssim = 0.95}};
  const Notable n = notable(all);
  EXPECT_EQ(n.worst, 1U);
  EXPECT_EQ(n.median, 2U);
  EXPECT_EQ(n.last, 4U);
}

}  // namespace
}  // namespace atlaswire::client
