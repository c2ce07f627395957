#include "base/ids.h"

#include <gtest/gtest.h>

namespace atlaswire {
namespace {

TEST(Ids, NextWraps) { EXPECT_EQ(next(FrameId{0xFFFFFFFFU}), FrameId{0}); }

TEST(Ids, SerialOrderSurvivesTheWrap) {
  EXPECT_TRUE(is_newer(FrameId{1}, FrameId{0}));
  EXPECT_FALSE(is_newer(FrameId{0}, FrameId{1}));
  EXPECT_FALSE(is_newer(FrameId{7}, FrameId{7}));
  EXPECT_TRUE(is_newer(FrameId{2}, FrameId{0xFFFFFFF0U}));
  EXPECT_FALSE(is_newer(FrameId{0xFFFFFFF0U}, FrameId{2}));
  EXPECT_TRUE(is_newer(PoseId{0x7FFFFFFFU}, PoseId{0}));
}

TEST(Ids, EachFrameIsNewerThanTheOneBefore) {
  FrameId id{0xFFFFFFF0U};
  for (int i = 0; i < 40; ++i) {
    ASSERT_TRUE(is_newer(next(id), id));
    id = next(id);
  }
}

}  // namespace
}  // namespace atlaswire
