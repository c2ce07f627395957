#include "client/sample.h"

#include "client/atlas_picture.h"

#include <gtest/gtest.h>

#include <vector>

namespace atlaswire::client {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(SampleSchedule, SpreadsSamplesOverTheMeasuredTime) {
  SampleSchedule schedule(4, seconds(1), seconds(9));
  std::vector<int> taken;
  for (int ms = 0; ms <= 9000; ms += 10) {
    if (schedule.take(milliseconds(ms))) taken.push_back(ms);
  }
  EXPECT_EQ(taken, (std::vector<int>{2000, 4000, 6000, 8000}));
}

TEST(SampleSchedule, TakesOneAFrameWhenFramesAreRare) {
  SampleSchedule schedule(3, seconds(0), seconds(3));
  EXPECT_TRUE(schedule.take(seconds(10)));
  EXPECT_TRUE(schedule.take(seconds(10)));
  EXPECT_TRUE(schedule.take(seconds(10)));
  EXPECT_FALSE(schedule.take(seconds(10)));
}

TEST(SampleSchedule, SamplesEndlessRunsOnceASecond) {
  SampleSchedule schedule(100, seconds(0), Duration{});
  EXPECT_FALSE(schedule.take(milliseconds(400)));
  EXPECT_TRUE(schedule.take(milliseconds(500)));
  EXPECT_FALSE(schedule.take(milliseconds(1400)));
  EXPECT_TRUE(schedule.take(milliseconds(1500)));
}

TEST(SampleSchedule, TakesNoneWhenNoneAreWanted) {
  SampleSchedule schedule(0, seconds(0), seconds(1));
  EXPECT_FALSE(schedule.take(seconds(5)));
}

TEST(AtlasPicture, ConvertsColoursAndLeavesOutTheCoverage) {
  // BT.709 full range: red is Y 54, Cb 99, Cr 255 (rounded).
  const std::vector<std::uint8_t> y(4 * 4, 54);
  const std::vector<std::uint8_t> u(2 * 2, 99);
  const std::vector<std::uint8_t> v(2 * 2, 255);
  const codec::I420View view{
      .extent = {4, 4}, .y = y.data(), .u = u.data(), .v = v.data(), .y_stride = 4, .uv_stride = 2};
  const render::Picture picture = atlas_picture(view, {4, 2});
  ASSERT_EQ(picture.extent, (Extent2D{4, 2}));
  const render::Rgba8 c = picture.at(3, 1);
  EXPECT_NEAR(c[0], 254, 2);
  EXPECT_NEAR(c[1], 0, 2);
  EXPECT_NEAR(c[2], 0, 2);
  EXPECT_EQ(c[3], 255);
}

}  // namespace
}  // namespace atlaswire::client
