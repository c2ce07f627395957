#include "base/grid.h"

#include "base/random.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace atlaswire {
namespace {

TEST(PositionGrid, CoversTheBoxWithCubicCells) {
  const PositionGrid grid = PositionGrid::over({-1, 0, 5}, {3, 2, 6}, 10);
  EXPECT_DOUBLE_EQ(grid.step, 4.0 / 1023.0);
  EXPECT_EQ(grid.quantize({-1, 0, 5}), GridPosition(0, 0, 0));
  EXPECT_EQ(grid.quantize({3, 0, 5}), GridPosition(1023, 0, 0));
}

TEST(PositionGrid, ErrorStaysWithinItsBoundAndComesNearIt) {
  const glm::dvec3 low(-10, 3, 0);
  const glm::dvec3 high(20, 9, 11);
  const PositionGrid grid = PositionGrid::over(low, high, 12);
  Random random(1);
  double worst = 0;
  for (int i = 0; i < 20'000; ++i) {
    const glm::dvec3 at =
        low + glm::dvec3(random.uniform(), random.uniform(), random.uniform()) * (high - low);
    worst = std::max(worst, glm::distance(at, grid.position(grid.quantize(at))));
  }
  EXPECT_LE(worst, grid.max_error() * (1 + 1e-9));
  EXPECT_GT(worst, 0.9 * grid.max_error());
}

TEST(PositionGrid, KeepsItsBoundFarFromTheOrigin) {
  const glm::dvec3 low(1e6, -1e6, 1e6);
  const PositionGrid grid = PositionGrid::over(low, low + glm::dvec3(10), 20);
  const glm::dvec3 at = low + glm::dvec3(1.2345, 6.789, 9.99);
  EXPECT_LE(glm::distance(at, grid.position(grid.quantize(at))), grid.max_error() * 1.001);
}

TEST(PositionGrid, ClampsPointsOutside) {
  const PositionGrid grid = PositionGrid::over({0, 0, 0}, {1, 1, 1}, 8);
  EXPECT_EQ(grid.quantize({-5, 0.5, 1e30}), GridPosition(0, 128, 255));
}

TEST(PositionGrid, GridPointsQuantizeToThemselves) {
  const PositionGrid grid = PositionGrid::over({0.1, 0.2, 0.3}, {7, 8, 9}, 16);
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const auto axis = [&] { return static_cast<std::uint32_t>(random.below(65536)); };
    const GridPosition p(axis(), axis(), axis());
    ASSERT_EQ(grid.quantize(grid.position(p)), p);
  }
}

TEST(PositionGrid, BoxOfNoSizeHasAStep) {
  const PositionGrid grid = PositionGrid::over({4, 4, 4}, {4, 4, 4}, 16);
  EXPECT_EQ(grid.step, 0x1.0p-20);
  EXPECT_EQ(grid.quantize({4, 4, 4}), GridPosition(0));
}

TEST(PositionGrid, SuitedBitsKeepTheStepBelowTwoMillimetres) {
  const auto bits = [](double side) {
    return PositionGrid::suited_bits(glm::dvec3(0), glm::dvec3(side, 1, 1));
  };
  EXPECT_EQ(bits(30), 16U);
  EXPECT_EQ(bits(200), 17U);
  EXPECT_EQ(bits(1500), 20U);
  EXPECT_EQ(bits(1e6), 20U) << "the finest there is";
  EXPECT_EQ(bits(0), 16U);
}

}  // namespace
}  // namespace atlaswire
