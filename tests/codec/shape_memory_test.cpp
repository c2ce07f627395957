#include "codec/shape_memory.h"

#include "codec/forecast.h"

#include <gtest/gtest.h>

#include <array>

namespace atlaswire::codec {
namespace {

using Point = glm::ivec3;
constexpr std::int32_t kTop = (1 << 20) - 1;

/// A gate, and a corner beyond it.
struct Part {
  Point from, to, behind_from, behind_to, corner;
};

constexpr Part kPart{
    {5000, 4000, 3000}, {5600, 4100, 3000}, {4900, 3500, 3200}, {5500, 3600, 3210}, {5700, 4900, 2700}};

template <class Turn>
Part turned(const Part& part, Turn turn) {
  return {turn(part.from), turn(part.to), turn(part.behind_from), turn(part.behind_to), turn(part.corner)};
}

GateFrame frame_of(const Part& part) {
  return *GateFrame::over(part.from, part.to, part.behind_from, part.behind_to);
}

TEST(GateFrame, GivesAPlaceBack) {
  const GateFrame frame = frame_of(kPart);
  EXPECT_EQ(frame.position(frame.place(kPart.corner), kTop), kPart.corner);
}

TEST(GateFrame, TellsTurnedAndMovedCopiesAlike) {
  const GateFrame frame = frame_of(kPart);
  const std::array copies{
      turned(kPart, [](const Point& p) { return Point(p.x + 77123, p.y + 5, p.z + 400000); }),
      turned(kPart, [](const Point& p) { return Point(100000 - p.y, 2000 + p.x, p.z); }),
      turned(kPart, [](const Point& p) { return Point(p.z, p.x, p.y); }),
      // By the Pythagorean triple 3, 4, 5: off the grid by less than a step on each axis.
      turned(kPart, [](const Point& p) {
        return Point((3 * p.x - 4 * p.y) / 5 + 90000, (4 * p.x + 3 * p.y) / 5, p.z);
      })};
  for (const Part& copy : copies) {
    const GateFrame other = frame_of(copy);
    EXPECT_EQ(other.lengths(), frame.lengths());
    EXPECT_LE(grid_distance(other.position(frame.place(kPart.corner), kTop), copy.corner), 6U);
  }
}

TEST(GateFrame, ClampsToTheGrid) {
  const GateFrame frame = frame_of(kPart);
  EXPECT_EQ(frame.position({1e30F, 0, 0}, kTop), Point(kTop, kTop, 3000));
  EXPECT_EQ(frame.position({-1e30F, 0, 0}, kTop), Point(0, 0, 3000));
}

TEST(GateFrame, NeedsAnEdgeAndAnAreaBehindIt) {
  const Point a{10, 10, 10};
  const Point b{20, 10, 10};
  EXPECT_FALSE(GateFrame::over(a, a, b, b));
  EXPECT_FALSE(GateFrame::over(a, b, {15, 10, 10}, {40, 10, 10}));
  EXPECT_TRUE(GateFrame::over(a, b, {15, 11, 10}, {15, 11, 10}));
}

TEST(ShapeMemory, ForetellsWhatIsAsItWas) {
  ShapeMemory memory;
  const GateCorner corner{frame_of(kPart), 4};
  EXPECT_EQ(memory.recall(corner), nullptr);
  memory.learn(corner, kPart.corner);
  ASSERT_NE(memory.recall(corner), nullptr);
  EXPECT_EQ(corner.frame.position(*memory.recall(corner), kTop), kPart.corner);
  EXPECT_EQ(memory.recall({corner.frame, 5}), nullptr);
  memory.clear();
  EXPECT_EQ(memory.recall(corner), nullptr);
}

TEST(ShapeMemory, KeepsSilentAfterAMissUntilItHoldsAgain) {
  ShapeMemory memory;
  const GateCorner corner{frame_of(kPart), 0};
  const Point elsewhere = kPart.corner + Point(0, 16, 0);
  memory.learn(corner, kPart.corner);
  memory.learn(corner, elsewhere);
  EXPECT_EQ(memory.recall(corner), nullptr);
  memory.learn(corner, elsewhere + Point(5, 5, 5));
  ASSERT_NE(memory.recall(corner), nullptr);
  EXPECT_EQ(corner.frame.position(*memory.recall(corner), kTop), elsewhere + Point(5, 5, 5));
}

}  // namespace
}  // namespace atlaswire::codec
