#include "base/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace atlaswire {
namespace {

TEST(Random, SeedsThroughSplitMix64AsPublished) {
  // First draws of the authors' xoshiro256** with the state SplitMix64 gives for these seeds, computed
  // apart from this code.
  Random zero(0);
  EXPECT_EQ(zero.bits(), 0x99EC5F36CB75F2B4ULL);
  EXPECT_EQ(zero.bits(), 0xBF6E1F784956452AULL);
  Random other(42);
  EXPECT_EQ(other.bits(), 0x15780B2E0C2EC716ULL);
  EXPECT_EQ(other.bits(), 0x6104D9866D113A7EULL);
}

TEST(Random, EqualSeedsGiveEqualDraws) {
  Random a(9);
  Random b(9);
  Random c(10);
  int different = 0;
  for (int i = 0; i < 100; ++i) {
    const std::uint64_t draw = a.bits();
    ASSERT_EQ(draw, b.bits());
    different += draw != c.bits() ? 1 : 0;
  }
  EXPECT_EQ(different, 100);
}

TEST(Random, UniformHasTheMomentsOfTheUnitInterval) {
  Random random(1);
  constexpr int kDraws = 200'000;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    squares += u * u;
  }
  // Five standard errors: mean 1/2 (variance 1/12), second moment 1/3 (variance 4/45).
  EXPECT_NEAR(sum / kDraws, 0.5, 5 * std::sqrt(1.0 / 12 / kDraws));
  EXPECT_NEAR(squares / kDraws, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / kDraws));
}

TEST(Random, BelowIsUniform) {
  Random random(2);
  constexpr int kDraws = 70'000;
  std::array<int, 7> counts{};
  for (int i = 0; i < kDraws; ++i) ++counts.at(random.below(7));
  double chi_square = 0;
  for (const int count : counts) chi_square += (count - 10'000.0) * (count - 10'000.0) / 10'000.0;
  EXPECT_LT(chi_square, 22.5);  // 6 degrees of freedom, probability 0.001
  EXPECT_EQ(random.below(1), 0U);
}

TEST(Random, BelowIsUniformForBoundsNearTheTop) {
  // A plain modulo would give the lower half twice as often.
  Random random(3);
  const std::uint64_t bound = 0xC000000000000000ULL;
  int low = 0;
  for (int i = 0; i < 30'000; ++i) low += random.below(bound) < bound / 3 ? 1 : 0;
  EXPECT_NEAR(low, 10'000, 5 * std::sqrt(30'000.0 * 2 / 9));
}

TEST(Random, NormalHasTheMomentsOfTheNormal) {
  Random random(4);
  constexpr int kDraws = 200'000;
  std::array<double, 4> moments{};
  int within_one = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double n = random.normal();
    for (std::size_t k = 0; k < moments.size(); ++k) moments[k] += std::pow(n, static_cast<double>(k + 1));
    within_one += std::abs(n) < 1 ? 1 : 0;
  }
  EXPECT_NEAR(moments[0] / kDraws, 0, 5 * std::sqrt(1.0 / kDraws));
  EXPECT_NEAR(moments[1] / kDraws, 1, 5 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(moments[2] / kDraws, 0, 5 * std::sqrt(15.0 / kDraws));
  EXPECT_NEAR(moments[3] / kDraws, 3, 5 * std::sqrt(96.0 / kDraws));
  EXPECT_NEAR(static_cast<double>(within_one) / kDraws, 0.682689, 5 * std::sqrt(0.2166 / kDraws));
}

}  // namespace
}  // namespace atlaswire
