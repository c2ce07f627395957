#include "render/atlas/patch_set.h"

#include <gtest/gtest.h>

#include <vector>

namespace atlaswire::render {
namespace {

PatchSet set_of(std::initializer_list<std::uint32_t> patches) {
  PatchSet set;
  for (const std::uint32_t patch : patches) set.insert(PatchId{patch});
  return set;
}

std::vector<std::uint32_t> members(const PatchSet& set) {
  std::vector<std::uint32_t> out;
  set.for_each([&](PatchId patch) { out.push_back(value(patch)); });
  return out;
}

std::vector<std::uint32_t> beyond(const PatchSet& set, const PatchSet& other) {
  std::vector<std::uint32_t> out;
  set.for_each_not_in(other, [&](PatchId patch) { out.push_back(value(patch)); });
  return out;
}

TEST(PatchSet, NamesItsMembersAscending) {
  const PatchSet set = set_of({200, 63, 0, 64, 127, 63});
  EXPECT_EQ(members(set), (std::vector{0U, 63U, 64U, 127U, 200U}));
  EXPECT_TRUE(set.contains(PatchId{127}));
  EXPECT_FALSE(set.contains(PatchId{126}));
  EXPECT_FALSE(set.contains(PatchId{1'000'000}));
}

TEST(PatchSet, ForgetsOneOrAll) {
  PatchSet set = set_of({5, 70, 71});
  set.erase(PatchId{70});
  set.erase(PatchId{1'000'000});
  EXPECT_EQ(members(set), (std::vector{5U, 71U}));
  set.clear();
  EXPECT_EQ(members(set), std::vector<std::uint32_t>{});
}

TEST(PatchSet, TellsSetsOfDifferentReachApart) {
  const PatchSet low = set_of({1, 2, 65});
  const PatchSet high = set_of({2, 3, 300});
  EXPECT_EQ(beyond(low, high), (std::vector{1U, 65U}));
  EXPECT_EQ(beyond(high, low), (std::vector{3U, 300U}));
}

}  // namespace
}  // namespace atlaswire::render
