#include "render/image/flip.h"

#include "base/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace atlaswire::render {
namespace {

constexpr Rgba8 kBlack{0, 0, 0, 255};
constexpr Rgba8 kWhite{255, 255, 255, 255};
constexpr Rgba8 kGreen{0, 255, 0, 255};
constexpr Rgba8 kBlue{0, 0, 255, 255};

Picture noise(std::uint64_t seed, Extent2D extent) {
  Random random(seed);
  Picture picture(extent);
  for (auto& byte : picture.rgba) byte = static_cast<std::uint8_t>(random.below(256));
  return picture;
}

Picture checkers(Extent2D extent, std::uint8_t low, std::uint8_t high) {
  Picture picture(extent);
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 0; x < extent.width; ++x) {
      const std::uint8_t v = (x + y) % 2 == 0 ? low : high;
      picture.set(x, y, {v, v, v, 255});
    }
  }
  return picture;
}

TEST(Flip, IsZeroForEqualPicturesAndIgnoresAlpha) {
  const Picture a = noise(1, {40, 30});
  Picture clear = a;
  for (std::size_t i = 3; i < clear.rgba.size(); i += 4) clear.rgba[i] = 0;
  const FlipMap map = flip_map(a, clear);
  ASSERT_EQ(map.extent, (Extent2D{40, 30}));
  EXPECT_TRUE(std::all_of(map.values.begin(), map.values.end(), [](float v) { return v == 0; }));
}

// Flat pictures have no features, and their blur changes nothing: the redistributed colour distance is left.
// Tolerances: an error of 1e-7 in XYZ, which is float, is one of 2e-4 in the chroma of a light grey.
TEST(Flip, MatchesTheClosedFormOfFlatPictures) {
  const Extent2D extent{24, 16};
  // By hand: Lab (100, 0, 0) and (0, 0, 0). From green to blue, Hunt adjusted, is 203.302 apart, the largest.
  const double largest = std::pow(203.302, 0.7);
  const double knee = 0.4 * largest;
  const double black_to_white = std::pow(100.0, 0.7);
  ASSERT_GT(black_to_white, knee);
  const double expected = 0.95 + 0.05 * (black_to_white - knee) / (largest - knee);
  EXPECT_NEAR(flip(Picture(extent, kBlack), Picture(extent, kWhite)), expected, 2e-5);
  EXPECT_NEAR(flip(Picture(extent, kGreen), Picture(extent, kBlue)), 1, 1e-5);
  // Grey 119 has L* = 50.03444, grey 118 has 49.63701 (below the knee, where the map is linear in d^0.7).
  const Picture grey(extent, {119, 119, 119, 255});
  EXPECT_NEAR(flip(grey, Picture(extent, {118, 118, 118, 255})), 0.95 * std::pow(0.39742, 0.7) / knee, 3e-5);
}

TEST(Flip, IsSymmetricAndWithinZeroAndOne) {
  const Picture a = noise(2, {50, 33});
  const Picture b = noise(3, {50, 33});
  for (const double ppd : {1.0, 8.4, kFlipPixelsPerDegree, 300.0}) {
    const FlipMap ab = flip_map(a, b, ppd);
    EXPECT_EQ(ab.values, flip_map(b, a, ppd).values);
    for (const float v : ab.values) ASSERT_TRUE(v >= 0 && v <= 1) << v;
  }
}

TEST(Flip, ForgivesWhatIsTooFineToSee) {
  const Extent2D extent{64, 64};
  const Picture fine = checkers(extent, 100, 156);
  const Picture flat(extent, {131, 131, 131, 255});  // the same mean light
  const double near = flip(fine, flat, 10);
  const double far = flip(fine, flat, 120);
  EXPECT_GT(near, 0.2);
  EXPECT_LT(far, 0.3 * near);
}

TEST(Flip, RaisesDifferencesOfEdges) {
  const Extent2D extent{64, 32};
  const Picture flat(extent, {128, 128, 128, 255});
  Picture step = flat;
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 32; x < extent.width; ++x) step.set(x, y, {160, 160, 160, 255});
  }
  const FlipMap map = flip_map(flat, step);
  const auto at = [&map](std::size_t x) { return map.values[16 * 64 + x]; };
  EXPECT_EQ(at(8), 0);               // far from the edge on the equal side
  EXPECT_GT(at(33), 1.2F * at(60));  // at the edge more than in the evenly different area
  EXPECT_GT(at(60), 0.1F);
}

TEST(Flip, DefinesEmptyAndTinyPictures) {
  EXPECT_TRUE(std::isnan(flip(Picture(), Picture())));
  EXPECT_EQ(flip_map(Picture(), Picture()).values.size(), 0U);
  EXPECT_NEAR(flip(Picture({1, 1}, kGreen), Picture({1, 1}, kBlue)), 1, 1e-5);
}

}  // namespace
}  // namespace atlaswire::render
