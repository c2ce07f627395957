#include "base/bytes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>

namespace atlaswire {
namespace {

ByteBuffer bytes_of(std::initializer_list<int> octets) {
  ByteBuffer out;
  for (const int octet : octets) out.push_back(static_cast<std::byte>(octet));
  return out;
}

TEST(ByteWriter, WritesMostSignificantOctetFirst) {
  ByteBuffer out;
  ByteWriter writer(out);
  writer.write(std::uint8_t{0xAB});
  writer.write(std::uint16_t{0x0102});
  writer.write(std::int32_t{-2});
  writer.write(1.0F);
  EXPECT_EQ(out, bytes_of({0xAB, 0x01, 0x02, 0xFF, 0xFF, 0xFF, 0xFE, 0x3F, 0x80, 0x00, 0x00}));
}

TEST(ByteReader, ReadsBackEveryWidth) {
  ByteBuffer out;
  ByteWriter writer(out);
  writer.write(std::numeric_limits<std::uint64_t>::max() - 1);
  writer.write(std::numeric_limits<std::int64_t>::min());
  writer.write(std::int16_t{-300});
  writer.write(-0.1);
  writer.write(std::numeric_limits<float>::infinity());
  ByteReader reader(out);
  EXPECT_EQ(reader.read<std::uint64_t>(), std::numeric_limits<std::uint64_t>::max() - 1);
  EXPECT_EQ(reader.read<std::int64_t>(), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(reader.read<std::int16_t>(), -300);
  EXPECT_EQ(reader.read<double>(), -0.1);
  EXPECT_TRUE(std::isinf(reader.read<float>()));
  EXPECT_TRUE(reader.finished());
}

TEST(ByteReader, StaysFailedPastTheEnd) {
  const ByteBuffer bytes = bytes_of({1, 2, 3});
  ByteReader reader(bytes);
  EXPECT_EQ(reader.read<std::uint32_t>(), 0U);
  EXPECT_FALSE(reader.ok());
  EXPECT_EQ(reader.read<std::uint8_t>(), 0U);
  EXPECT_FALSE(reader.finished());
  EXPECT_EQ(reader.remaining(), 0U);
}

TEST(ByteReader, BorrowsOnlyWhatIsThere) {
  const ByteBuffer bytes = bytes_of({1, 2, 3});
  ByteReader reader(bytes);
  EXPECT_EQ(reader.read_bytes(2).size(), 2U);
  EXPECT_TRUE(reader.read_bytes(std::numeric_limits<std::size_t>::max()).empty());
  EXPECT_FALSE(reader.ok());
}

TEST(Varint, RoundTripsEveryLength) {
  for (unsigned bit = 0; bit < 64; ++bit) {
    for (const std::uint64_t v : {(std::uint64_t{1} << bit) - 1, std::uint64_t{1} << bit}) {
      ByteBuffer out;
      ByteWriter(out).write_varint(v);
      ByteReader reader(out);
      EXPECT_EQ(reader.read_varint(), v);
      EXPECT_TRUE(reader.finished());
    }
  }
}

TEST(Varint, HasTheGoldenForm) {
  ByteBuffer out;
  ByteWriter writer(out);
  writer.write_varint(300);
  writer.write_signed_varint(-1);
  writer.write_signed_varint(1);
  writer.write_signed_varint(-65);
  EXPECT_EQ(out, bytes_of({0xAC, 0x02, 0x01, 0x02, 0x81, 0x01}));
}

TEST(Varint, RoundTripsSignedExtremes) {
  for (const std::int64_t v : {std::numeric_limits<std::int64_t>::min(), std::int64_t{-1}, std::int64_t{0},
                               std::numeric_limits<std::int64_t>::max()}) {
    ByteBuffer out;
    ByteWriter(out).write_signed_varint(v);
    ByteReader reader(out);
    EXPECT_EQ(reader.read_signed_varint(), v);
    EXPECT_TRUE(reader.finished());
  }
}

TEST(Varint, RejectsMoreThan64BitsAndMissingOctets) {
  const ByteBuffer too_large = bytes_of({0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x02});
  ByteReader large(too_large);
  EXPECT_EQ(large.read_varint(), 0U);
  EXPECT_FALSE(large.ok());
  const ByteBuffer too_long = bytes_of({0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x00});
  ByteReader longer(too_long);
  EXPECT_EQ(longer.read_varint(), 0U);
  EXPECT_FALSE(longer.ok());
  const ByteBuffer cut = bytes_of({0x80});
  ByteReader early(cut);
  EXPECT_EQ(early.read_varint(), 0U);
  EXPECT_FALSE(early.ok());
}

}  // namespace
}  // namespace atlaswire
