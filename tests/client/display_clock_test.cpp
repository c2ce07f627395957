#include "client/display_clock.h"

#include <gtest/gtest.h>

namespace atlaswire::client {
namespace {

using std::chrono::milliseconds;

Time at(int ms) { return Time{milliseconds(ms)}; }

TEST(DisplayClock, KeepsTheRateWhenDrawingIsQuick) {
  DisplayClock clock(100);
  EXPECT_EQ(clock.next(at(1000)), at(1000));
  EXPECT_EQ(clock.next(at(1003)), at(1010));
  EXPECT_EQ(clock.next(at(1011)), at(1020));
}

TEST(DisplayClock, MissesRefreshesWithoutCatchingUp) {
  DisplayClock clock(100);
  clock.next(at(1000));
  EXPECT_EQ(clock.next(at(1034)), at(1040)) << "three refreshes missed";
  EXPECT_EQ(clock.next(at(1041)), at(1050)) << "and no burst after them";
}

TEST(DisplayClock, TakesARefreshThatIsDueNow) {
  DisplayClock clock(100);
  clock.next(at(1000));
  EXPECT_EQ(clock.next(at(1010)), at(1010));
}

TEST(DisplayClock, RunsFreeAtRateZero) {
  DisplayClock clock(0);
  EXPECT_EQ(clock.next(at(5)), at(5));
  EXPECT_EQ(clock.next(at(6)), at(6));
}

}  // namespace
}  // namespace atlaswire::client
