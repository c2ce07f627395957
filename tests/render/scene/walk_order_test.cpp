#include "render/scene/walk_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <vector>

namespace atlaswire::render {
namespace {

constexpr std::uint32_t kSide = 12;

/// A sheet of quads, each with four vertices of its own, numbered in an order without sense.
struct Sheet {
  Sheet() {
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      const std::uint32_t cell = i * 77 % (kSide * kSide);  // 77 has no divisor in common with 144
      const auto first = static_cast<std::uint32_t>(positions.size());
      const auto x = static_cast<float>(cell % kSide);
      const auto y = static_cast<float>(cell / kSide);
      positions.insert(positions.end(), {{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}});
      groups.push_back({{first, first + 1, first + 2, first + 3, first + 3}, 2 * i, 2});
      cells.push_back(cell);
    }
  }
  [[nodiscard]] bool beside(std::uint32_t a, std::uint32_t b) const {
    const auto apart = [](std::uint32_t p, std::uint32_t q) {
      return std::abs(static_cast<int>(p) - static_cast<int>(q));
    };
    return apart(cells[a] % kSide, cells[b] % kSide) + apart(cells[a] / kSide, cells[b] / kSide) == 1;
  }
  std::vector<glm::vec3> positions;
  std::vector<TriangleGroup> groups;
  std::vector<std::uint32_t> cells;
};

std::vector<std::uint32_t> all(std::size_t count) {
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0U);
  return numbers;
}

/// How many are beside one of the three before.
std::size_t near_ones(const Sheet& sheet, const std::vector<std::uint32_t>& walk) {
  std::size_t near = 0;
  for (std::size_t i = 1; i < walk.size(); ++i) {
    for (std::size_t back = 1; back <= std::min<std::size_t>(3, i); ++back) {
      if (!sheet.beside(walk[i], walk[i - back])) continue;
      ++near;
      break;
    }
  }
  return near;
}

TEST(WalkOrder, GoesFromNeighbourToNeighbourAcrossSeams) {
  const Sheet sheet;
  std::vector<std::uint32_t> walk = all(sheet.groups.size());
  EXPECT_LT(near_ones(sheet, walk), walk.size() / 4);
  WalkOrder(sheet.positions, sheet.groups).arrange(walk);
  EXPECT_GE(near_ones(sheet, walk), walk.size() * 9 / 10);
  std::ranges::sort(walk);
  EXPECT_EQ(walk, all(sheet.groups.size()));
}

TEST(WalkOrder, BeginsEachPartWhereItTouchesTheLast) {
  const Sheet sheet;
  WalkOrder order(sheet.positions, sheet.groups);
  std::vector<std::uint32_t> left;
  std::vector<std::uint32_t> right;
  for (const std::uint32_t group : all(sheet.groups.size())) {
    (sheet.cells[group] % kSide < kSide / 2 ? left : right).push_back(group);
  }
  order.arrange(left);
  order.arrange(right);
  EXPECT_EQ(sheet.cells[right.front()] % kSide, kSide / 2);
}

TEST(WalkOrder, TakesPatchesThatTouchNothing) {
  std::vector<glm::vec3> positions;
  std::vector<TriangleGroup> groups;
  for (std::uint32_t i = 0; i < 5; ++i) {
    const auto x = static_cast<float>(10 * i);
    positions.insert(positions.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}});
    groups.push_back({{3 * i, 3 * i + 1, 3 * i + 2, 3 * i + 2, 3 * i + 2}, i, 1});
  }
  std::vector<std::uint32_t> walk{4, 2, 0};
  WalkOrder(positions, groups).arrange(walk);
  EXPECT_EQ(walk, (std::vector<std::uint32_t>{4, 2, 0})) << "as given";
  std::vector<std::uint32_t> none;
  WalkOrder({}, {}).arrange(none);
}

}  // namespace
}  // namespace atlaswire::render
