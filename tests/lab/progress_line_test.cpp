#include "lab/progress_line.h"

#include <gtest/gtest.h>

namespace atlaswire::lab {
namespace {

using namespace std::chrono_literals;

TEST(ProgressLine, BarShowsShareCountAndTimeLeft) {
  EXPECT_EQ(progress_bar({10, 0, 0}, 5s), "[..............................] 0/10 points");
  EXPECT_EQ(progress_bar({10, 4, 0.5}, 60s), "[###############...............] 4/10 points, 60 s left");
  EXPECT_EQ(progress_bar({10, 10, 1}, 60s), "[##############################] 10/10 points");
}

TEST(ProgressLine, FinishedPointsSayHow) {
  const Failure failure{"id", "ATW", 4, "no Vulkan device"};
  EXPECT_EQ(finished_line({2, 1, 0.5, "ATW", 12.2, nullptr}), "ATW: done in 12 s");
  EXPECT_EQ(finished_line({2, 1, 0.5, "ATW", 12.2, &failure}), "ATW: failed (exit code 4): no Vulkan device");
}

TEST(ProgressLine, TimesAreRough) {
  EXPECT_EQ(rough_time(1400ms), "1 s");
  EXPECT_EQ(rough_time(10min), "10 min");
  EXPECT_EQ(rough_time(2h), "2.0 h");
  EXPECT_EQ(rough_time(-1s), "0 s");
}

}  // namespace
}  // namespace atlaswire::lab
