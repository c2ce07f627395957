#include "codec/gate_table.h"

#include <gtest/gtest.h>

#include <vector>

namespace atlaswire::codec {
namespace {

Outline outline(std::initializer_list<std::uint32_t> corners) {
  Outline out;
  for (const std::uint32_t corner : corners) out.corners[out.count++] = corner;
  return out;
}

std::vector<std::uint32_t> leaving(const GateTable& gates, std::uint32_t vertex) {
  std::vector<std::uint32_t> out;
  for (auto g = gates.first_leaving(vertex); g != GateTable::kNone; g = gates.next_leaving(g)) {
    EXPECT_EQ(gates.gate(g).from, vertex);
    out.push_back(gates.gate(g).to);
  }
  return out;
}

std::vector<std::uint32_t> arriving(const GateTable& gates, std::uint32_t vertex) {
  std::vector<std::uint32_t> out;
  for (auto g = gates.first_arriving(vertex); g != GateTable::kNone; g = gates.next_arriving(g)) {
    EXPECT_EQ(gates.gate(g).to, vertex);
    out.push_back(gates.gate(g).from);
  }
  return out;
}

using Vertices = std::vector<std::uint32_t>;

TEST(GateTable, OpensBehindEveryEdgeOfALonePatch) {
  GateTable gates(1);
  gates.add(outline({0, 1, 2, 3}));
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t number = gates.find((i + 1) % 4, i);
    ASSERT_NE(number, GateTable::kNone);
    EXPECT_EQ(gates.gate(number).behind_from, (i + 2) % 4);
    EXPECT_EQ(gates.gate(number).behind_to, (i + 3) % 4);
    EXPECT_EQ(gates.find(i, (i + 1) % 4), GateTable::kNone);
  }
}

TEST(GateTable, ClosesWhereTwoPatchesMeet) {
  GateTable gates(1);
  gates.add(outline({0, 1, 2}));
  gates.add(outline({1, 0, 3}));
  EXPECT_EQ(gates.find(1, 0), GateTable::kNone);
  EXPECT_EQ(gates.find(0, 1), GateTable::kNone);
  EXPECT_EQ(leaving(gates, 0), Vertices{2});
  EXPECT_EQ(arriving(gates, 0), Vertices{3});
  EXPECT_EQ(leaving(gates, 1), Vertices{3});
  EXPECT_EQ(arriving(gates, 1), Vertices{2});
}

TEST(GateTable, ListsTheLatestFirst) {
  GateTable gates(1);
  gates.add(outline({0, 1, 2}));
  gates.add(outline({0, 3, 4}));
  gates.add(outline({0, 5, 6}));
  EXPECT_EQ(leaving(gates, 0), (Vertices{6, 4, 2}));
  EXPECT_EQ(arriving(gates, 0), (Vertices{5, 3, 1}));
  gates.add(outline({0, 4, 9}));  // in the middle of the list
  EXPECT_EQ(leaving(gates, 0), (Vertices{9, 6, 2}));
  EXPECT_EQ(arriving(gates, 0), (Vertices{5, 3, 1}));
}

TEST(GateTable, HasOneGateWhereManyPatchesMeet) {
  GateTable gates(1);
  for (std::uint32_t i = 2; i < 6; ++i) gates.add(outline({0, 1, i}));
  EXPECT_EQ(leaving(gates, 1), Vertices{0});
  EXPECT_EQ(gates.gate(gates.find(1, 0)).behind_from, 2U);
}

/// A fan about vertex 0 with gaps, so that its gates are many, closed in another order than opened in.
TEST(GateTable, FindsEveryGateOfACrowdedVertex) {
  constexpr std::uint32_t kSpokes = 64;
  GateTable gates(1);
  std::vector<bool> open(kSpokes, false);
  const auto check = [&](std::uint32_t step) {
    for (std::uint32_t s = 0; s < kSpokes; ++s) {
      const std::uint32_t number = gates.find(0, 1 + s);
      ASSERT_EQ(number != GateTable::kNone, open[s]) << "spoke " << s << ", step " << step;
      if (open[s]) {
        ASSERT_EQ(gates.gate(number).to, 1 + s);
      }
    }
  };
  for (std::uint32_t s = 0; s < kSpokes; ++s) {
    gates.add(outline({1 + s, 0, 100 + s}));
    open[s] = true;
    check(s);
  }
  for (std::uint32_t i = 0; i < kSpokes; ++i) {
    const std::uint32_t closed = i * 37 % kSpokes;
    gates.add(outline({0, 1 + closed, 200 + closed}));
    open[closed] = false;
    check(i);
    if (i % 3 != 0) continue;
    const std::uint32_t again = i * 19 % kSpokes;
    if (open[again]) continue;
    gates.add(outline({1 + again, 0, 300 + again}));
    open[again] = true;
    check(i);
  }
}

TEST(GateTable, LeavesOutEdgesOfNoLength) {
  GateTable gates(1);
  gates.add(outline({7, 7, 7}));
  EXPECT_EQ(gates.first_leaving(7), GateTable::kNone);
  gates.add(outline({0, 0, 1}));  // out and back: the second edge fills what the first opens
  EXPECT_EQ(gates.first_leaving(0), GateTable::kNone);
  EXPECT_EQ(gates.first_arriving(0), GateTable::kNone);
}

TEST(GateTable, ForgetsAllWhenCleared) {
  GateTable gates(1);
  gates.add(outline({0, 1, 2}));
  gates.clear();
  EXPECT_EQ(gates.find(1, 0), GateTable::kNone);
  EXPECT_EQ(gates.first_leaving(1), GateTable::kNone);
}

}  // namespace
}  // namespace atlaswire::codec
