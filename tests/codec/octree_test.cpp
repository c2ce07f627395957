#include "codec/octree.h"

#include "base/random.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace atlaswire::codec {
namespace {

using Points = std::vector<GridPosition>;

ByteBuffer encoded(Points points, std::uint32_t bits) {
  std::ranges::stable_sort(points, {}, octree_order);
  ByteBuffer out;
  BitWriter writer(out);
  write_octree(points, bits, writer);
  writer.finish();
  return out;
}

void expect_round_trip(Points points, std::uint32_t bits) {
  const ByteBuffer bytes = encoded(points, bits);
  BitReader reader(bytes);
  const auto back = read_octree(reader, static_cast<std::uint32_t>(points.size()), bits);
  ASSERT_TRUE(back);
  EXPECT_TRUE(reader.finished());
  std::ranges::stable_sort(points, {}, octree_order);
  EXPECT_TRUE(*back == points);
}

Points random_points(std::uint32_t count, std::uint32_t bits, std::uint64_t seed) {
  Random random(seed);
  const auto axis = [&] { return static_cast<std::uint32_t>(random.below(1U << bits)); };
  Points points;
  for (std::uint32_t i = 0; i < count; ++i) points.emplace_back(axis(), axis(), axis());
  return points;
}

TEST(Octree, WritesGoldenBits) {
  // Two points in opposite corners of a grid of 4: a node of several points, its children 0 and 7, each with
  // one point whose lower bits follow. Of the masks of two children, behind eight of one, 0x81 is the 22nd:
  // number 29, in order 3 00100101. So 0 | 00100101 | 1 000 | 1 111.
  const ByteBuffer bytes = encoded({{0, 0, 0}, {3, 3, 3}}, 2);
  BitReader bits(bytes);
  EXPECT_EQ(bytes.size(), 3U);
  EXPECT_EQ(bits.read(17), 0b0'00100101'1000'1111U);
}

TEST(Octree, KeepsNoPointAndOne) {
  expect_round_trip({}, 16);
  expect_round_trip({{1, 2, 3}}, 16);
  EXPECT_EQ(encoded({{1, 2, 3}}, 16).size(), 7U);  // a bit and three times 16
}

TEST(Octree, KeepsPointsThatAreAllEqual) {
  expect_round_trip(Points(1000, {77, 0, 65535}), 16);
  expect_round_trip(Points(2, {0, 0, 0}), 0);
}

TEST(Octree, KeepsTheCornersOfTheFinestGrid) {
  constexpr std::uint32_t kTop = (1U << 20U) - 1;
  Points points;
  for (std::uint32_t i = 0; i < 8; ++i)
    points.emplace_back((i & 1U) * kTop, (i >> 1U & 1U) * kTop, (i >> 2U) * kTop);
  expect_round_trip(points, 20);
}

TEST(Octree, KeepsAMillionPoints) { expect_round_trip(random_points(1U << 20U, 20, 5), 20); }

TEST(Octree, TakesFewBitsWhereASurfaceIsDense) {
  Points points;
  for (std::uint32_t x = 0; x < 128; ++x) {
    for (std::uint32_t y = 0; y < 128; ++y) points.emplace_back(x, y, (x * x + y) / 160);
  }
  EXPECT_LT(encoded(points, 16).size() * 8, points.size() * 6);
}

TEST(Octree, RefusesOtherCounts) {
  const ByteBuffer bytes = encoded(random_points(40, 10, 1), 10);
  for (const std::uint32_t count : {0U, 1U, 39U, 41U, 1000U}) {
    BitReader reader(bytes);
    const auto points = read_octree(reader, count, 10);
    EXPECT_EQ(points.has_value(), count == 0) << count;
  }
}

TEST(Octree, RefusesTruncationsAndSurvivesFlips) {
  const ByteBuffer whole = encoded(random_points(50, 12, 2), 12);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    BitReader cut(ByteView(whole).first(at));
    EXPECT_FALSE(read_octree(cut, 50, 12)) << at;
    for (const unsigned mask : {0x01U, 0x80U, 0xFFU}) {
      ByteBuffer bent = whole;
      bent[at] ^= static_cast<std::byte>(mask);
      BitReader reader(bent);
      const auto points = read_octree(reader, 50, 12);
      if (points) {
        EXPECT_EQ(points->size(), 50U);
      }
    }
  }
}

}  // namespace
}  // namespace atlaswire::codec
