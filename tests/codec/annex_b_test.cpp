#include "codec/annex_b.h"

#include <gtest/gtest.h>

#include <initializer_list>

namespace atlaswire::codec {
namespace {

ByteBuffer bytes_of(std::initializer_list<int> octets) {
  ByteBuffer out;
  for (const int octet : octets) out.push_back(static_cast<std::byte>(octet));
  return out;
}

std::vector<ByteBuffer> units_of(const ByteBuffer& stream) {
  std::vector<ByteBuffer> out;
  AnnexBReader reader(stream);
  while (const auto unit = reader.next()) out.emplace_back(unit->begin(), unit->end());
  return out;
}

TEST(AnnexBReader, SplitsAtBothStartCodes) {
  const auto units = units_of(bytes_of({0, 0, 0, 1, 0x67, 5, 0, 0, 1, 0x68, 0, 3, 0, 0, 0, 1, 0x65, 9}));
  ASSERT_EQ(units.size(), 3U);
  EXPECT_EQ(units[0], bytes_of({0x67, 5}));
  EXPECT_EQ(units[1], bytes_of({0x68, 0, 3}));
  EXPECT_EQ(units[2], bytes_of({0x65, 9}));
}

TEST(AnnexBReader, SkipsWhatIsNoUnit) {
  EXPECT_TRUE(units_of({}).empty());
  EXPECT_TRUE(units_of(bytes_of({1, 2, 3, 0, 0})).empty());
  EXPECT_TRUE(units_of(bytes_of({0, 0, 1})).empty());
  EXPECT_TRUE(units_of(bytes_of({0, 0, 1, 0, 0, 1, 0, 0, 0})).empty());
  EXPECT_EQ(units_of(bytes_of({7, 7, 0, 0, 1, 0x41})).size(), 1U);
}

TEST(AnnexBReader, FindsParameterSetsAndIdr) {
  const auto stream = bytes_of({0, 0, 1, 0x06, 1, 0, 0, 1, 0x67, 5, 0, 0, 1, 0x68, 6, 0, 0, 1, 0x65, 9});
  EXPECT_EQ(parameter_sets_of(stream), bytes_of({0, 0, 0, 1, 0x67, 5, 0, 0, 0, 1, 0x68, 6}));
  EXPECT_TRUE(contains_idr(stream));
  EXPECT_FALSE(contains_idr(bytes_of({0, 0, 1, 0x41, 9, 0, 0, 1, 0x67, 5})));
}

}  // namespace
}  // namespace atlaswire::codec
