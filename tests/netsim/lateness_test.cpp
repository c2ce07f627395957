#include "netsim/lateness.h"

#include <gtest/gtest.h>

namespace atlaswire::netsim {
namespace {

TEST(Lateness, QuantilesRoundUpToWholeMicroseconds) {
  Lateness lateness;
  EXPECT_EQ(lateness.quantile_us(0.5), 0);
  for (int i = 1; i <= 100; ++i) lateness.add(Time{}, Time{std::chrono::microseconds(i)});
  EXPECT_EQ(lateness.quantile_us(0.5), 50);
  EXPECT_EQ(lateness.quantile_us(0.99), 99);
  EXPECT_EQ(lateness.quantile_us(1), 100);
  lateness.add(Time{}, Time{Duration{1}});
  EXPECT_EQ(lateness.quantile_us(0.001), 1) << "never less late than it was";
}

TEST(Lateness, TheMostIsExactBeyondTheHistogram) {
  Lateness lateness;
  lateness.add(Time{}, Time{std::chrono::milliseconds(250)});
  lateness.add(Time{Duration{5}}, Time{});
  EXPECT_EQ(lateness.most_us(), 250'000);
  EXPECT_EQ(lateness.quantile_us(1), 10'000);
  EXPECT_EQ(lateness.quantile_us(0.5), 0) << "early counts as on time";
}

}  // namespace
}  // namespace atlaswire::netsim
