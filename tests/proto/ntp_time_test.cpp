#include "proto/ntp_time.h"

#include "tests/proto/vocabulary.h"

#include <gtest/gtest.h>

namespace atlaswire::proto {
namespace {

using test::at;
using namespace std::chrono_literals;

TEST(NtpTime, KnownValues) {
  EXPECT_EQ(to_ntp(at(0s)), 0U);
  EXPECT_EQ(to_ntp(at(1500ms)), 0x1'8000'0000U);
  EXPECT_EQ(to_ntp(at(-500ms)), 0xFFFF'FFFF'8000'0000U);
  EXPECT_EQ(middle(0x1234'5678'9ABC'DEF0U), 0x5678'9ABCU);
}

TEST(NtpTime, ComesBackToTheNanosecond) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const Time t = from_nanos(static_cast<std::int64_t>(random.below(0xFFFF'FFFFULL * 1'000'000'000ULL)));
    ASSERT_EQ(from_ntp(to_ntp(t)), t);
  }
  EXPECT_EQ(from_ntp(to_ntp(at(999'999'999ns))), at(999'999'999ns));
}

TEST(RtpTime, Runs90TicksAMillisecondAndWraps) {
  EXPECT_EQ(to_rtp_time(at(1ms), 0), 90U);
  EXPECT_EQ(to_rtp_time(at(1s), 0xFFFFFFFF), 89'999U);
  EXPECT_EQ(to_rtp_time(at(-1s), 90'000), 0U);
  const Time late = at(1h * 24 * 365);
  EXPECT_EQ(to_rtp_time(late + 10ms, 5) - to_rtp_time(late, 5), 900U);
  EXPECT_EQ(to_rtp_time(late, 5), static_cast<std::uint32_t>(31'536'000ULL * 90'000ULL + 5));
}

}  // namespace
}  // namespace atlaswire::proto
