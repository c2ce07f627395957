#include "codec/transform_grid.h"

#include "base/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

namespace atlaswire::codec {
namespace {

double angle_between(const glm::dquat& a, const glm::dquat& b) {
  const glm::dquat between = glm::inverse(a) * b;
  return 2 * std::atan2(glm::length(glm::dvec3(between.x, between.y, between.z)), std::abs(between.w));
}

TEST(TransformGrid, KeepsItsBounds) {
  Random random(1);
  for (const std::uint32_t bits : {8U, 12U, 16U, 20U}) {
    const TransformGrid grid{.step = 0.01, .rotation_bits = bits};
    double worst = 0;
    for (int i = 0; i < 20'000; ++i) {
      RigidTransform t;
      t.translation = 1e4 * glm::dvec3(random.normal(), random.normal(), random.normal());
      t.orientation =
          glm::normalize(glm::dquat(random.normal(), random.normal(), random.normal(), random.normal()));
      if (i % 3 == 0)
        t.orientation = glm::normalize(glm::dquat(1.0, 1 - 1e-3 * random.uniform(), 1.0, random.uniform()));
      const auto on_grid = grid.quantize(t);
      ASSERT_TRUE(on_grid);
      const RigidTransform back = grid.transform(*on_grid);
      ASSERT_LE(glm::distance(back.translation, t.translation), grid.max_translation_error());
      worst = std::max(worst, angle_between(t.orientation, back.orientation));
    }
    EXPECT_LE(worst, grid.max_rotation_error());
    EXPECT_GE(worst, 0.5 * grid.max_rotation_error()) << "the bound is not idle";
  }
}

TEST(TransformGrid, TakesBothQuaternionsOfOneOrientation) {
  const TransformGrid grid;
  const glm::dquat q = glm::normalize(glm::dquat(-0.1, 0.7, -0.2, 0.6));
  EXPECT_EQ(grid.quantize({.orientation = q}), grid.quantize({.orientation = -q}));
  EXPECT_EQ(grid.quantize({.orientation = q}), grid.quantize({.orientation = 1.5 * q}));
}

TEST(TransformGrid, RestIsNoTransform) {
  const TransformGrid grid;
  EXPECT_EQ(grid.quantize({}), grid.rest());
  EXPECT_EQ(grid.transform(grid.rest()).orientation, glm::dquat(1, 0, 0, 0));
}

TEST(TransformGrid, RefusesWhatIsNoTransform) {
  const TransformGrid grid{.step = 1.0};
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(grid.quantize({.translation = {kNaN, 0, 0}}));
  EXPECT_FALSE(grid.quantize({.translation = {0, 0, -3e8}}));
  EXPECT_TRUE(grid.quantize({.translation = {0, 0, -2e8}}));
  EXPECT_FALSE(grid.quantize({.orientation = {kNaN, 0, 0, 0}}));
  EXPECT_FALSE(grid.quantize({.orientation = {0.4, 0, 0, 0}}));
  EXPECT_FALSE(grid.quantize({.orientation = {2.1, 0, 0, 0}}));
}

TEST(TransformGrid, LeavesNothingForALargestMemberThatIsTooSmall) {
  const TransformGrid grid{.step = 1.0, .rotation_bits = 8};
  GridTransform t{.rotation = {200, 200, 0, 0}, .largest = 3};
  EXPECT_FALSE(grid.complete(t));
  t.rotation = {0, -256, 0, 0};
  EXPECT_TRUE(grid.complete(t));
  EXPECT_EQ(t.rotation[3], 0);
}

}  // namespace
}  // namespace atlaswire::codec
