#include "render/image/metrics.h"

#include "base/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace atlaswire::render {
namespace {

const Picture kEmpty;

Picture noise(std::uint64_t seed, Extent2D extent) {
  Random random(seed);
  Picture picture(extent);
  for (auto& byte : picture.rgba) byte = static_cast<std::uint8_t>(random.below(256));
  return picture;
}

Picture gradient(Extent2D extent) {
  Picture picture(extent);
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 0; x < extent.width; ++x) {
      picture.set(x, y, {std::uint8_t(3 * x), std::uint8_t(2 * y + x), std::uint8_t(x ^ y), 255});
    }
  }
  return picture;
}

Picture disturbed(const Picture& from, std::uint64_t seed, int amount) {
  Random random(seed);
  Picture picture = from;
  for (auto& byte : picture.rgba) {
    const int draw = static_cast<int>(random.below(static_cast<std::uint64_t>(2 * amount + 1))) - amount;
    byte = static_cast<std::uint8_t>(std::clamp(int{byte} + draw, 0, 255));
  }
  return picture;
}

double luma(const Picture& p, std::uint32_t x, std::uint32_t y) {
  const Rgba8 c = p.at(x, y);
  return (0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]) / 255;
}

/// The definition of Wang et al. at one window: two passes, double, one 2D kernel.
double direct_ssim(const Picture& a, const Picture& b, std::uint32_t left, std::uint32_t top) {
  double weights[11][11];
  double sum = 0;
  for (int v = 0; v < 11; ++v) {
    for (int u = 0; u < 11; ++u) {
      weights[v][u] = std::exp(-((u - 5) * (u - 5) + (v - 5) * (v - 5)) / (2 * 2.0 * 2.0));
      sum += weights[v][u];
    }
  }
  const auto mean_of = [&](auto value) {
    double mean = 0;
    for (std::uint32_t v = 0; v < 11; ++v) {
      for (std::uint32_t u = 0; u < 11; ++u) mean += weights[v][u] / sum * value(left + u, top + v);
    }
    return mean;
  };
  const double ma = mean_of([&](auto x, auto y) { return luma(a, x, y); });
  const double mb = mean_of([&](auto x, auto y) { return luma(b, x, y); });
  const double va = mean_of([&](auto x, auto y) { return (luma(a, x, y) - ma) * (luma(a, x, y) - ma); });
  const double vb = mean_of([&](auto x, auto y) { return (luma(b, x, y) - mb) * (luma(b, x, y) - mb); });
  const double cov = mean_of([&](auto x, auto y) { return (luma(a, x, y) - ma) * (luma(b, x, y) - mb); });
  return (2 * ma * mb + 0.0001) * (2 * cov + 0.0009) / ((ma * ma + mb * mb + 0.0001) * (va + vb + 0.0009));
}

TEST(Ssim, AgreesWithTheDefinitionAtEveryWindow) {
  const Extent2D extent{37, 29};
  const std::pair<Picture, Picture> cases[] = {
      {noise(1, extent), noise(2, extent)},
      {gradient(extent), disturbed(gradient(extent), 3, 12)},
      {gradient(extent), disturbed(gradient(extent), 4, 1)},
      {Picture(extent, {250, 250, 250, 255}), disturbed(Picture(extent, {250, 250, 250, 255}), 5, 2)}};
  for (const auto& [a, b] : cases) {
    const SsimMap map = ssim_map(a, b);
    ASSERT_EQ(map.extent, (Extent2D{27, 19}));
    double sum = 0;
    for (std::uint32_t y = 0; y < map.extent.height; ++y) {
      for (std::uint32_t x = 0; x < map.extent.width; ++x) {
        const double expected = direct_ssim(a, b, x, y);
        ASSERT_NEAR(map.values[y * map.extent.width + x], expected, 2e-4) << x << ' ' << y;
        sum += expected;
      }
    }
    EXPECT_NEAR(mssim(a, b), sum / static_cast<double>(map.extent.area()), 2e-5);
  }
}

TEST(Ssim, IsOneForEqualPictures) {
  for (const Picture& p : {noise(1, {40, 30}), gradient({11, 11}), Picture({50, 20}, {255, 255, 255, 255})}) {
    EXPECT_NEAR(mssim(p, p), 1.0, 1e-5);
  }
}

TEST(Ssim, ComparesOnlyBrightnessOfFlatPictures) {
  const Picture a({20, 20}, {51, 51, 51, 255});
  const Picture b({20, 20}, {204, 204, 204, 255});
  const double expected = (2 * 0.2 * 0.8 + 1e-4) / (0.2 * 0.2 + 0.8 * 0.8 + 1e-4);
  EXPECT_NEAR(mssim(a, b), expected, 1e-3);
  EXPECT_NEAR(mssim(Picture({20, 20}, {0, 0, 0, 255}), Picture({20, 20}, {255, 255, 255, 255})),
              1e-4 / 1.0001, 1e-5);
}

TEST(Ssim, IsNegativeForAnInvertedPattern) {
  Picture a({32, 32});
  Picture b({32, 32});
  for (std::uint32_t y = 0; y < 32; ++y) {
    for (std::uint32_t x = 0; x < 32; ++x) {
      const std::uint8_t v = (x + y) % 2 == 0 ? 0 : 255;
      const auto w = static_cast<std::uint8_t>(255 - v);
      a.set(x, y, {v, v, v, 255});
      b.set(x, y, {w, w, w, 255});
    }
  }
  EXPECT_LT(mssim(a, b), -0.9);
}

TEST(Ssim, IgnoresAlphaAndIsSymmetric) {
  const Picture a = gradient({30, 30});
  const Picture b = disturbed(a, 8, 20);
  Picture clear = b;
  for (std::size_t i = 3; i < clear.rgba.size(); i += 4) clear.rgba[i] = 0;
  EXPECT_EQ(mssim(a, b), mssim(a, clear));
  EXPECT_NEAR(mssim(a, b), mssim(b, a), 1e-6);
}

TEST(Ssim, IsUndefinedBelowOneWindow) {
  EXPECT_TRUE(std::isnan(mssim(Picture({10, 40}), Picture({10, 40}))));
  EXPECT_TRUE(std::isnan(mssim(Picture(), Picture())));
  EXPECT_EQ(ssim_map(Picture({11, 11}), Picture({11, 11})).values.size(), 1U);
}

TEST(Psnr, MatchesItsClosedForm) {
  const Picture a({16, 16}, {100, 100, 100, 255});
  const Picture b({16, 16}, {110, 110, 110, 255});
  EXPECT_NEAR(psnr(a, b), 20 * std::log10(255.0 / 10), 1e-9);
  const Picture one_channel({16, 16}, {100, 110, 100, 0});
  EXPECT_NEAR(psnr(a, one_channel), 10 * std::log10(255.0 * 255 * 3 / 100), 1e-9);
  EXPECT_EQ(psnr(a, a), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(psnr(Picture({4, 4}, {0, 0, 0, 255}), Picture({4, 4}, {255, 255, 255, 255})), 0, 1e-12);
  EXPECT_TRUE(std::isnan(psnr(Picture(), Picture())));
}

TEST(Dssim, IsHalfOfWhatSsimLacks) {
  EXPECT_DOUBLE_EQ(dssim(1), 0);
  EXPECT_DOUBLE_EQ(dssim(0.9), 0.05);
  EXPECT_DOUBLE_EQ(dssim(-1), 1);
}

TEST(Flicker, ComparesChangesOfLumaAndNotPictures) {
  const Picture dark({8, 4}, {51, 51, 51, 255});
  const Picture light({8, 4}, {102, 102, 102, 0});
  const Picture black({8, 4}, {0, 0, 0, 255});
  EXPECT_EQ(flicker({&dark, &light}, {&dark, &light}), 0);            // wrong, but steady
  EXPECT_NEAR(flicker({&black, &dark}, {&dark, &light}), 0, 1e-7);    // wrong, but brightening alike
  EXPECT_NEAR(flicker({&dark, &dark}, {&dark, &light}), 0.2, 1e-6);   // flashes
  EXPECT_NEAR(flicker({&dark, &light}, {&light, &dark}), 0.4, 1e-6);  // the wrong way
  const Picture white({8, 4}, {255, 255, 255, 255});
  EXPECT_NEAR(flicker({&black, &white}, {&white, &black}), 2, 1e-6);
  Picture half = dark;
  for (std::uint32_t x = 0; x < 8; ++x) half.set(x, 0, {51, 255, 51, 255});
  EXPECT_NEAR(flicker({&dark, &dark}, {&dark, &half}), 0.25 * 0.8 * 0.7152, 1e-6);
  EXPECT_TRUE(std::isnan(flicker({&kEmpty, &kEmpty}, {&kEmpty, &kEmpty})));
}

TEST(HoleShare, CountsPixelsWithoutAlpha) {
  Picture p({4, 2});
  EXPECT_EQ(hole_share(p), 0);
  p.set(0, 0, {9, 9, 9, 0});
  p.set(3, 1, {0, 0, 0, 0});
  EXPECT_DOUBLE_EQ(hole_share(p), 0.25);
  EXPECT_EQ(hole_share(Picture()), 0);
}

}  // namespace
}  // namespace atlaswire::render
