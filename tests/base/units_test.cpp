#include "base/units.h"

#include <gtest/gtest.h>

namespace atlaswire {
namespace {

using namespace std::chrono_literals;

TEST(ParseExtent, ReadsWidthAndHeight) {
  EXPECT_EQ(parse_extent("1024x512").value(), (Extent2D{1024, 512}));
  EXPECT_EQ(parse_extent("1x32768").value(), (Extent2D{1, 32768}));
}

TEST(ParseExtent, RejectsEverythingElse) {
  for (const char* text : {"", "x", "1024", "1024x", "x512", "0x5", "5x0", "-1x5", "1024x512x", "1024 x512",
                           "10X20", "32769x1", "99999999999x1", "1.5x2"}) {
    const auto result = parse_extent(text);
    ASSERT_FALSE(result) << text;
    EXPECT_EQ(result.error().code, units::UnitError::kBadExtent);
    EXPECT_NE(result.error().message().find("'" + std::string(text) + "'"), std::string::npos);
  }
}

TEST(ParseBitRate, ReadsSuffixes) {
  EXPECT_EQ(parse_bit_rate("10M").value().bits_per_second, 10'000'000U);
  EXPECT_EQ(parse_bit_rate("800k").value().bits_per_second, 800'000U);
  EXPECT_EQ(parse_bit_rate("2.5G").value().bits_per_second, 2'500'000'000U);
  EXPECT_EQ(parse_bit_rate("1234").value().bits_per_second, 1234U);
  EXPECT_EQ(parse_bit_rate("0").value().bits_per_second, 0U);
}

TEST(ParseBitRate, RejectsEverythingElse) {
  for (const char* text : {"", "M", "-1M", "10m", "10MM", "10 M", "nan", "inf", "1e30", "5000G"}) {
    const auto result = parse_bit_rate(text);
    ASSERT_FALSE(result) << text;
    EXPECT_EQ(result.error().code, units::UnitError::kBadBitRate);
  }
}

TEST(BitRate, TimeForBytes) {
  EXPECT_EQ(BitRate{8'000'000}.time_for(Bytes{1'000}), 1ms);
  EXPECT_EQ(BitRate{8}.time_for(Bytes{0}), 0ns);
  EXPECT_EQ(BitRate{0}.time_for(Bytes{1}), Duration::max());
  EXPECT_DOUBLE_EQ(BitRate{2'500'000}.mbps(), 2.5);
}

TEST(Extent, AreaDoesNotOverflow) {
  EXPECT_EQ((Extent2D{0xFFFFFFFFU, 0xFFFFFFFFU}).area(), 0xFFFFFFFE00000001ULL);
}

}  // namespace
}  // namespace atlaswire
