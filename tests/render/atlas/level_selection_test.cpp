#include "render/atlas/level_selection.h"

#include "base/program.h"
#include "base/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace atlaswire::render {
namespace {

AllocatorSettings atlas_of(std::uint32_t side, std::uint32_t superblock = 6, std::uint32_t least = 1) {
  return {.atlas = {side, side}, .superblock_log2 = superblock, .min_block_log2 = least};
}

std::uint64_t area_of(const BlockRequest& r) { return std::uint64_t{1} << (r.width_log2 + r.height_log2); }

std::uint64_t area_of(const std::vector<BlockRequest>& requests) {
  std::uint64_t sum = 0;
  for (const auto& r : requests) sum += area_of(r);
  return sum;
}

/// Projections with areas of 2^low..2^high pixels and aspects up to 8; a share is hidden.
std::vector<std::uint32_t> random_projections(Random& random, std::size_t count, double low, double high) {
  std::vector<std::uint32_t> packed(count);
  for (auto& p : packed) {
    const double area = std::exp2(low + (high - low) * random.uniform());
    const double aspect = std::exp2(6 * random.uniform() - 3);
    if (random.uniform() < 0.7) p = pack_projection(area, aspect);
  }
  return packed;
}

/// [SAS] eq. 2 in real numbers: the nearest legal (A, a) by search, not by arithmetic.
struct Rounded {
  int area;
  int aspect;
};
Rounded brute_force(double log_area, double log_aspect, const AllocatorSettings& s) {
  const int low = 2 * static_cast<int>(s.min_block_log2);
  const int high = 2 * static_cast<int>(s.superblock_log2);
  Rounded best{low, 0};
  for (int area = low; area <= high; ++area) {
    if (std::abs(log_area - area) <= std::abs(log_area - best.area)) best.area = area;
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (int w = low / 2; w <= high / 2; ++w) {
    const int h = best.area - w;
    if (h < low / 2 || h > high / 2) continue;
    if (std::abs(log_aspect - (w - h)) <= nearest) {
      nearest = std::abs(log_aspect - (w - h));
      best.aspect = w - h;
    }
  }
  return best;
}

TEST(PackProjection, HoldsLogarithmsIn256thsAndNeverMeansInvisible) {
  EXPECT_EQ(pack_projection(1, 1), 16384U);
  EXPECT_EQ(pack_projection(256, 0.5), (0xFF00U << 16U) | (16384U + 2048U));
  EXPECT_NE(pack_projection(0, 1), 0U);
  EXPECT_NE(pack_projection(0, 0), 0U);
  EXPECT_NE(pack_projection(-1, -1), 0U);
  EXPECT_NE(pack_projection(std::nan(""), std::nan("")), 0U);
  EXPECT_EQ(pack_projection(1e300, 1) & 0xFFFFU, 0xFFFFU);
}

TEST(RoundLevel, FindsTheNearestLegalBlock) {
  for (const auto& s : {atlas_of(256, 6, 1), atlas_of(256, 6, 0), atlas_of(256, 4, 4), atlas_of(256, 5, 3)}) {
    for (std::int32_t area = -700; area <= 16 * 256; area += 37) {
      for (std::int32_t aspect = -8 * 256; aspect <= 8 * 256; aspect += 53) {
        const BlockRequest r = round_level(PatchId{0}, area, aspect, s);
        const Rounded expected = brute_force(area / 256.0, aspect / 256.0, s);
        ASSERT_EQ(r.width_log2 + r.height_log2, expected.area) << area << ' ' << aspect;
        ASSERT_GE(r.width_log2, r.height_log2);
        ASSERT_LE(r.width_log2, s.superblock_log2);
        ASSERT_GE(r.height_log2, s.min_block_log2);
        const int signed_aspect = (r.transposed ? -1 : 1) * (r.width_log2 - r.height_log2);
        const double error = std::abs(aspect / 256.0 - signed_aspect);
        ASSERT_DOUBLE_EQ(error, std::abs(aspect / 256.0 - expected.aspect)) << area << ' ' << aspect;
        ASSERT_FALSE(signed_aspect == 0 && r.transposed);
      }
    }
  }
}

TEST(MemoryBias, SolvesTheEquationOfThePaper) {
  EXPECT_DOUBLE_EQ(memory_bias(2048, 0, 1024), 1);
  EXPECT_DOUBLE_EQ(memory_bias(1024, 0, 1024), 0);
  EXPECT_DOUBLE_EQ(memory_bias(512, 0, 1024), -1);
  for (const double fixed : {0.0, 10.0, 500.0}) {
    const double b = memory_bias(5000, fixed, 1000);
    EXPECT_NEAR((5000 - fixed) * std::exp2(-b) + fixed, 1000, 1e-9);
  }
}

TEST(MemoryBias, HasAnswersWhereTheFormulaEnds) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(memory_bias(100, 100, 1000), -infinity);
  EXPECT_EQ(memory_bias(0, 0, 1000), -infinity);
  EXPECT_EQ(memory_bias(5000, 1000, 1000), infinity);
  EXPECT_EQ(memory_bias(2000, 2000, 1000), infinity);
}

TEST(LevelSelector, FillsTheAtlasButDoesNotOverflowIt) {
  Random random(5);
  std::vector<BlockRequest> out;
  for (int round = 0; round < 60; ++round) {
    const double high = 4 + 8 * random.uniform();
    const auto packed = random_projections(random, 2000, high - 6, high);
    LevelSettings settings{.allocator = atlas_of(256), .max_oversampling = 4096};
    LevelSelector selector(settings, 2000);
    const LevelStats stats = selector.select(packed, out);
    const auto target = static_cast<std::uint64_t>(LevelSettings{}.target_fill * 256 * 256);
    EXPECT_EQ(stats.texels, area_of(out));
    EXPECT_LE(stats.texels, target);
    // One bias step less must not fit: an eighth of the patches would double at most.
    EXPECT_GE(static_cast<double>(stats.texels), static_cast<double>(target) * 0.8) << round;
  }
}

TEST(LevelSelector, TakesTheSmallestBiasThatFits) {
  Random random(6);
  for (int round = 0; round < 20; ++round) {
    const auto packed = random_projections(random, 500, 0, 14);
    const LevelSettings settings{.allocator = atlas_of(256)};
    LevelSelector selector(settings, 500);
    std::vector<BlockRequest> out;
    const double bias = selector.select(packed, out).bias;
    const auto texels_at = [&](double b) {
      std::uint64_t sum = 0;
      for (const auto p : packed) {
        if (p == 0) continue;
        const auto area = static_cast<std::int32_t>(p & 0xFFFFU) - 16384 - static_cast<std::int32_t>(b * 256);
        sum += area_of(round_level(PatchId{0}, area, 0, settings.allocator));
      }
      return static_cast<double>(sum);
    };
    const double target = LevelSettings{}.target_fill * 256 * 256;
    EXPECT_LE(texels_at(bias), target);
    if (bias > -1) {
      EXPECT_GT(texels_at(bias - 0.125), target);
    }
  }
}

TEST(LevelSelector, GrowsNoMoreThanOversamplingAllows) {
  const std::vector<std::uint32_t> packed(4, pack_projection(64, 1));
  std::vector<BlockRequest> out;
  for (const auto& [oversampling, bias] : {std::pair{1.0, 0.0}, {2.0, -1.0}, {4.0, -2.0}}) {
    LevelSelector selector({.allocator = atlas_of(1024), .max_oversampling = oversampling}, 4);
    EXPECT_DOUBLE_EQ(selector.select(packed, out).bias, bias);
    EXPECT_DOUBLE_EQ(static_cast<double>(area_of(out[0])), 64 * oversampling);
  }
}

TEST(LevelSelector, GivesOnlySmallestBlocksWhenNotEvenTheyFit) {
  const std::vector<std::uint32_t> packed(5000, pack_projection(1e9, 1));
  LevelSelector selector({.allocator = atlas_of(64)}, 5000);
  std::vector<BlockRequest> out;
  const LevelStats stats = selector.select(packed, out);
  ASSERT_EQ(out.size(), 5000U);
  for (const auto& r : out) ASSERT_EQ(area_of(r), 4U);
  EXPECT_GT(stats.texels, 64U * 64U);
}

TEST(LevelSelector, SeesNothingInAnEmptySetAndKeepsItsBias) {
  LevelSelector selector({.allocator = atlas_of(64)}, 100);
  std::vector<BlockRequest> out{{}};
  const std::vector<std::uint32_t> full(100, pack_projection(1000, 1));
  const std::vector<std::uint32_t> nothing(100, 0);
  selector.select(nothing, out);
  EXPECT_TRUE(out.empty());
  const double bias = selector.select(full, out).bias;
  EXPECT_GT(bias, 0);
  EXPECT_EQ(selector.select(nothing, out).bias, bias);
  EXPECT_TRUE(out.empty());
}

TEST(LevelSelector, ListsVisiblePatchesAscending) {
  std::vector<std::uint32_t> packed(10, 0);
  packed[3] = packed[7] = pack_projection(16, 0.25);
  LevelSelector selector({.allocator = atlas_of(64)}, 10);
  std::vector<BlockRequest> out;
  EXPECT_EQ(selector.select(packed, out).visible, 2U);
  ASSERT_EQ(out.size(), 2U);
  EXPECT_EQ(out[0].patch, PatchId{3});
  EXPECT_EQ(out[1].patch, PatchId{7});
  EXPECT_TRUE(out[0].transposed);
}

TEST(LevelSelector, KeepsALevelWithinTheMarginAndChangesItBeyond) {
  LevelSelector selector({.allocator = atlas_of(1024), .max_oversampling = 1}, 1);
  std::vector<BlockRequest> out;
  const auto area_after = [&](double log_area) {
    selector.select(std::vector{pack_projection(std::exp2(log_area), 1)}, out);
    return area_of(out[0]);
  };
  EXPECT_EQ(area_after(6.0), 64U);
  EXPECT_EQ(area_after(6.7), 64U);   // would round to 128
  EXPECT_EQ(area_after(5.3), 64U);   // would round to 32
  EXPECT_EQ(area_after(6.8), 128U);  // past 6.75
  EXPECT_EQ(area_after(6.3), 128U);
  EXPECT_EQ(area_after(6.2), 64U);
}

TEST(LevelSelector, KeepsAShapeWithinTheMargin) {
  LevelSelector selector({.allocator = atlas_of(1024), .max_oversampling = 1}, 1);
  std::vector<BlockRequest> out;
  const auto shape_after = [&](double log_aspect) {
    selector.select(std::vector{pack_projection(128, std::exp2(log_aspect))}, out);
    return (out[0].transposed ? -1 : 1) * (out[0].width_log2 - out[0].height_log2);
  };
  EXPECT_EQ(shape_after(0.2), 1);
  EXPECT_EQ(shape_after(-0.4), 1);  // would round to -1
  EXPECT_EQ(shape_after(-0.6), -1);
  EXPECT_EQ(shape_after(0.4), -1);
  EXPECT_EQ(shape_after(20), 5);  // clamped: 64 x 2
  EXPECT_EQ(shape_after(30), 5);
}

TEST(LevelSelector, HysteresisNeverCostsTheAtlas) {
  Random random(9);
  LevelSelector selector({.allocator = atlas_of(128), .hysteresis = 1.0}, 3000);
  auto packed = random_projections(random, 3000, 2, 10);
  std::vector<BlockRequest> out;
  for (int frame = 0; frame < 200; ++frame) {
    // Everything recedes and comes back, so that hysteresis pulls upward for half of the time.
    const int drift = frame % 40 < 20 ? -20 : 20;
    for (auto& p : packed) {
      if (p != 0) p = (p & 0xFFFF0000U) | static_cast<std::uint32_t>(static_cast<int>(p & 0xFFFFU) + drift);
    }
    const LevelStats stats = selector.select(packed, out);
    ASSERT_EQ(stats.texels, area_of(out));
    ASSERT_LE(stats.texels, static_cast<std::uint64_t>(LevelSettings{}.target_fill * 128 * 128)) << frame;
  }
}

TEST(LevelSelector, TakesHysteresisBackWhenMemoryIsShort) {
  // 40 patches shrink within their margin while 50 others grow beyond theirs.
  std::vector<std::uint32_t> packed(90, pack_projection(64, 1));
  std::fill(packed.begin() + 40, packed.end(), pack_projection(16, 1));
  LevelSelector selector({.allocator = atlas_of(64), .target_fill = 0.85, .max_oversampling = 1}, 90);
  std::vector<BlockRequest> out;
  EXPECT_EQ(selector.select(packed, out).texels, 40U * 64 + 50U * 16);
  std::fill(packed.begin(), packed.begin() + 40, pack_projection(std::exp2(5.4), 1));
  std::fill(packed.begin() + 40, packed.end(), pack_projection(std::exp2(4.9), 1));
  const LevelStats stats = selector.select(packed, out);
  EXPECT_EQ(stats.bias, 0);
  EXPECT_EQ(stats.demoted, 22U);  // the first multiple of 32 texels that brings 4160 below 3481
  EXPECT_EQ(area_of(out), 4160U - 22U * 32U);
}

TEST(LevelSelector, SearchesDownFromTheEquationWhereRoundingSaves) {
  // Areas of 2^6.4 all round down: the equation asks for a bias, the blocks do not.
  const std::vector<std::uint32_t> packed(50, pack_projection(std::exp2(6.4), 1));
  LevelSelector selector({.allocator = atlas_of(64)}, 50);
  std::vector<BlockRequest> out;
  const LevelStats stats = selector.select(packed, out);
  EXPECT_GT(stats.one_step_bias, 0.2);
  EXPECT_EQ(stats.bias, 0);
  EXPECT_EQ(stats.texels, 50U * 64);
}

TEST(LevelSelector, StandsStillUnderJitter) {
  Random random(10);
  LevelSelector selector({.allocator = atlas_of(128)}, 1000);
  const auto still = random_projections(random, 1000, 2, 10);
  std::vector<BlockRequest> first;
  std::vector<BlockRequest> out;
  for (int frame = 0; frame < 50; ++frame) {
    auto packed = still;
    for (auto& p : packed) {
      if (p != 0) p += static_cast<std::uint32_t>(random.below(17)) - 8;  // +-3 % of the area
    }
    const LevelStats stats = selector.select(packed, out);
    if (frame == 5) first = out;
    if (frame <= 5) continue;
    std::size_t changed = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      changed +=
          out[i].width_log2 != first[i].width_log2 || out[i].height_log2 != first[i].height_log2 ? 1 : 0;
    }
    EXPECT_LE(changed, out.size() / 50) << "frame " << frame << " bias " << stats.bias;
  }
}

TEST(LevelSelector, RaisesTheBiasAtOnceAndLowersItSlowly) {
  LevelSelector selector({.allocator = atlas_of(64)}, 64);
  std::vector<BlockRequest> out;
  const std::vector<std::uint32_t> near(64, pack_projection(1024, 1));
  const std::vector<std::uint32_t> far(64, pack_projection(64, 1));
  const double low = selector.select(far, out).bias;
  const double high = selector.select(near, out).bias;
  EXPECT_GE(high, low + 3);
  double before = high;
  int frames = 0;
  while (before > low + 0.25 && frames < 100) {
    const double now = selector.select(far, out).bias;
    EXPECT_LT(now, before);
    EXPECT_GE(now, before - (before - low) / 4 - 0.125);
    before = now;
    ++frames;
  }
  EXPECT_GT(frames, 5);
  EXPECT_LT(frames, 40);
}

TEST(LevelSelector, IsDeterministic) {
  Random random(12);
  LevelSelector a({.allocator = atlas_of(128)}, 1000);
  LevelSelector b({.allocator = atlas_of(128)}, 1000);
  std::vector<BlockRequest> left;
  std::vector<BlockRequest> right;
  for (int frame = 0; frame < 20; ++frame) {
    const auto packed = random_projections(random, 1000, 0, 12);
    a.select(packed, left);
    b.select(packed, right);
    ASSERT_TRUE(std::ranges::equal(left, right, [](const BlockRequest& l, const BlockRequest& r) {
      return l.patch == r.patch && l.width_log2 == r.width_log2 && l.height_log2 == r.height_log2 &&
             l.transposed == r.transposed;
    }));
  }
}

TEST(LevelSelector, RejectsSettingsOutOfRange) {
  EXPECT_THROW(LevelSelector({.target_fill = 0}, 1), ProgramError);
  EXPECT_THROW(LevelSelector({.max_oversampling = 0.5}, 1), ProgramError);
  EXPECT_THROW(LevelSelector({.hysteresis = std::nan("")}, 1), ProgramError);
}

}  // namespace
}  // namespace atlaswire::render
