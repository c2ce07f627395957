#include "codec/bit_io.h"

#include <gtest/gtest.h>

#include <array>

namespace atlaswire::codec {
namespace {

TEST(BitWriter, PutsTheHighestBitFirst) {
  ByteBuffer out;
  BitWriter writer(out);
  writer.write(0b101, 3);
  writer.write(0xFFFFFFFF, 32);
  writer.write(0, 0);
  writer.write(0b10, 2);
  writer.finish();
  EXPECT_EQ(
      out, (ByteBuffer{std::byte{0xBF}, std::byte{0xFF}, std::byte{0xFF}, std::byte{0xFF}, std::byte{0xF0}}));
}

TEST(BitWriter, WritesGolombCodes) {
  // Order 0: 1, 010, 011, 00100; order 2: 100, 111, 01000.
  ByteBuffer out;
  BitWriter writer(out);
  for (const std::uint32_t v : {0U, 1U, 2U, 3U}) writer.write_golomb(v, 0);
  for (const std::uint32_t v : {0U, 3U, 4U}) writer.write_golomb(v, 2);
  writer.finish();
  // 1010 0110 0100 1001 1101 000(0)
  EXPECT_EQ(out, (ByteBuffer{std::byte{0xA6}, std::byte{0x49}, std::byte{0xD0}}));
}

TEST(BitIo, CarriesNumbersOfEverySizeAndOrder) {
  ByteBuffer out;
  BitWriter writer(out);
  std::vector<std::uint32_t> numbers{0, 1, 0xFFFFFFFF, 0xFFFFFFFE, 0x80000000};
  for (std::uint32_t bit = 0; bit < 32; ++bit) numbers.push_back((1U << bit) - 1);
  std::uint64_t bits = 0;
  for (std::uint32_t order = 0; order < 32; ++order) {
    for (const std::uint32_t number : numbers) {
      writer.write_golomb(number, order);
      bits += BitWriter::golomb_length(number, order);
    }
  }
  writer.finish();
  EXPECT_EQ(out.size(), (bits + 7) / 8);
  BitReader reader(out);
  for (std::uint32_t order = 0; order < 32; ++order) {
    for (const std::uint32_t number : numbers) ASSERT_EQ(reader.read_golomb(order), number) << order;
  }
  EXPECT_TRUE(reader.finished());
}

TEST(BitReader, EndsForGoodBehindTheEnd) {
  const std::array octets{std::byte{0xFF}, std::byte{0x01}};
  BitReader reader(octets);
  EXPECT_EQ(reader.read(12), 0xFF0U);
  EXPECT_EQ(reader.read(5), 0U);
  EXPECT_FALSE(reader.ok());
  EXPECT_EQ(reader.read(1), 0U);
  EXPECT_FALSE(reader.finished());
}

TEST(BitReader, RefusesCodesOfMoreThan32Bits) {
  ByteBuffer zeros(9);
  EXPECT_FALSE([&] {
    BitReader reader(zeros);
    reader.read_golomb(0);
    return reader.ok();
  }());
  // 33 zeros, a one and 33 more would be a number beyond.
  zeros[4] = std::byte{0x40};
  BitReader reader(zeros);
  reader.read_golomb(0);
  EXPECT_FALSE(reader.ok());
}

TEST(BitReader, WantsZerosUpToTheEnd) {
  const std::array octets{std::byte{0x01}};
  BitReader reader(octets);
  reader.read(4);
  EXPECT_FALSE(reader.finished());
}

TEST(Zigzag, IsItsOwnInverse) {
  for (const std::int32_t v : {0, 1, -1, 1000, -1000, INT32_MAX, INT32_MIN})
    EXPECT_EQ(unzigzag(zigzag(v)), v);
  EXPECT_EQ(zigzag(-1), 1U);
  EXPECT_EQ(zigzag(1), 2U);
}

}  // namespace
}  // namespace atlaswire::codec
