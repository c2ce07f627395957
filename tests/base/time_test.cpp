#include "base/time.h"

#include <gtest/gtest.h>

#include <limits>

namespace atlaswire {
namespace {

using namespace std::chrono_literals;

TEST(Time, SecondsRoundToTheNearestNanosecond) {
  EXPECT_EQ(from_seconds(0.25), 250ms);
  EXPECT_EQ(from_seconds(-1.5), -1500ms);
  EXPECT_EQ(from_seconds(1.6e-9), 2ns);
  EXPECT_EQ(from_seconds(0), 0ns);
}

TEST(Time, SecondsSaturate) {
  EXPECT_EQ(from_seconds(1e30), Duration::max());
  EXPECT_EQ(from_seconds(-1e30), Duration::min());
  EXPECT_EQ(from_seconds(std::numeric_limits<double>::infinity()), Duration::max());
  EXPECT_EQ(from_seconds(-std::numeric_limits<double>::infinity()), Duration::min());
}

TEST(Time, NanosecondsRoundTrip) {
  for (const std::int64_t nanos :
       {std::int64_t{0}, std::int64_t{-5}, std::numeric_limits<std::int64_t>::max()}) {
    EXPECT_EQ(to_nanos(from_nanos(nanos)), nanos);
  }
}

TEST(Time, ReportsInMillisecondsAndSeconds) {
  EXPECT_DOUBLE_EQ(to_ms(1500us), 1.5);
  EXPECT_DOUBLE_EQ(to_seconds(250ms), 0.25);
}

}  // namespace
}  // namespace atlaswire
