#include "proto/framing.h"

#include "tests/proto/vocabulary.h"

#include <gtest/gtest.h>

namespace atlaswire::proto {
namespace {

using test::from_hex;
using test::to_hex;

TEST(FrameReader, GivesWholeEnvelopesOnly) {
  FrameReader reader;
  reader.feed(from_hex("00000003 0a0b"));
  EXPECT_FALSE(reader.next().value().has_value());
  EXPECT_EQ(reader.pending(), 6U);
  reader.feed(from_hex("0c 00000001 ff 0000"));
  EXPECT_EQ(to_hex(reader.next().value().value()), "0a0b0c");
  EXPECT_EQ(to_hex(reader.next().value().value()), "ff");
  EXPECT_FALSE(reader.next().value().has_value());
  EXPECT_EQ(reader.pending(), 2U);
}

TEST(FrameReader, IsIndifferentToHowTheStreamIsCut) {
  Random random(1);
  ByteBuffer stream;
  std::vector<ByteBuffer> sent;
  for (int i = 0; i < 200; ++i) {
    sent.push_back(test::noise(1 + random.below(3000), random));
    append_frame(sent.back(), stream);
  }
  FrameReader reader;
  std::vector<ByteBuffer> got;
  for (ByteView rest = stream; !rest.empty();) {
    const std::size_t chunk = std::min<std::size_t>(rest.size(), 1 + random.below(2000));
    reader.feed(rest.first(chunk));
    rest = rest.subspan(chunk);
    while (const auto envelope = reader.next().value()) got.emplace_back(envelope->begin(), envelope->end());
  }
  EXPECT_EQ(got, sent);
  EXPECT_EQ(reader.pending(), 0U);
}

TEST(FrameReader, RefusesAZeroLengthForGood) {
  FrameReader reader;
  reader.feed(from_hex("00000000 00000001 aa"));
  EXPECT_EQ(reader.next().error().code, WireError::kBadLength);
  EXPECT_EQ(reader.next().error().code, WireError::kBadLength);
  reader.feed(from_hex("00000001 aa"));
  EXPECT_EQ(reader.next().error().code, WireError::kBadLength);
  EXPECT_EQ(reader.pending(), 0U);
}

TEST(FrameReader, RefusesLengthsOverTheLimitAsSoonAsTheyAreRead) {
  FrameReader reader;
  reader.feed(from_hex("00010001"));
  const auto refused = reader.next();
  ASSERT_TRUE(refused.has_error());
  EXPECT_EQ(refused.error().code, WireError::kBadLength);
  EXPECT_NE(refused.error().message().find("65537"), std::string::npos);
}

TEST(FrameReader, TakesLargerEnvelopesOnceTheLimitIsRaised) {
  FrameReader reader;
  reader.set_limit(kMaxEnvelope);
  const ByteBuffer large(kMaxEnvelope, std::byte{7});
  ByteBuffer stream;
  append_frame(large, stream);
  reader.feed(stream);
  EXPECT_EQ(reader.next().value().value().size(), kMaxEnvelope);
  reader.feed(from_hex("00800001"));
  EXPECT_TRUE(reader.next().has_error());
}

}  // namespace
}  // namespace atlaswire::proto
