#include "proto/rtp.h"

#include "tests/proto/vocabulary.h"

#include <gtest/gtest.h>

namespace atlaswire::proto {
namespace {

using test::from_hex;
using test::to_hex;

RtpHeader full_header() {
  RtpHeader h;
  h.marker = true;
  h.sequence = 0xABCD;
  h.timestamp = 0x01020304;
  h.ssrc = 0x11223344;
  h.extensions = {FrameId{0x10}, PoseId{0x20}, NtpTime{0x0102030405060708}, std::uint16_t{0x99}};
  return h;
}

TEST(Rtp, GoldenBytesOfAFramesFirstPacket) {
  ByteBuffer out;
  append_rtp_header(full_header(), out);
  EXPECT_EQ(to_hex(out),
            "90e0abcd"
            "01020304"
            "11223344"
            "bede0006"
            "13"
            "00000010"
            "23"
            "00000020"
            "37"
            "0102030405060708"
            "41"
            "0099"
            "0000");
  EXPECT_EQ(out.size(), rtp_header_size(full_header().extensions));
}

TEST(Rtp, GoldenBytesOfALaterPacket) {
  RtpHeader h = full_header();
  h.marker = false;
  h.extensions.pose.reset();
  h.extensions.capture.reset();
  ByteBuffer out;
  append_rtp_header(h, out);
  EXPECT_EQ(to_hex(out),
            "9060abcd"
            "01020304"
            "11223344"
            "bede0002"
            "13"
            "00000010"
            "41"
            "0099");
}

TEST(Rtp, WithoutExtensionsTheHeaderIsTwelveOctets) {
  RtpHeader h = full_header();
  h.extensions = {};
  ByteBuffer out;
  append_rtp_header(h, out);
  EXPECT_EQ(to_hex(out), "80e0abcd0102030411223344");
}

TEST(Rtp, ComesBackAsSent) {
  ByteBuffer out;
  append_rtp_header(full_header(), out);
  const ByteBuffer payload = from_hex("65aabbcc");
  out.insert(out.end(), payload.begin(), payload.end());
  const auto got = parse_rtp(out).value();
  EXPECT_TRUE(got.header.marker);
  EXPECT_EQ(got.header.payload_type, 96);
  EXPECT_EQ(got.header.sequence, 0xABCD);
  EXPECT_EQ(got.header.timestamp, 0x01020304U);
  EXPECT_EQ(got.header.ssrc, 0x11223344U);
  EXPECT_EQ(got.header.extensions.frame, FrameId{0x10});
  EXPECT_EQ(got.header.extensions.pose, PoseId{0x20});
  EXPECT_EQ(got.header.extensions.capture, NtpTime{0x0102030405060708});
  EXPECT_EQ(got.header.extensions.transport_sequence, 0x99);
  EXPECT_EQ(to_hex(got.payload), "65aabbcc");
}

TEST(Rtp, SkipsCsrcListsUnknownExtensionsAndPadding) {
  const ByteBuffer datagram = from_hex(
      "b2600001 00000002 00000003 aaaaaaaa bbbbbbbb"
      "bede0003 52010203 00 13000000 07 f0 00"
      "41 42 00 0003");
  const auto got = parse_rtp(datagram);
  ASSERT_TRUE(got.has_value());
  EXPECT_EQ(got->header.extensions.frame, FrameId{7});
  EXPECT_EQ(to_hex(got->payload), "4142");
}

TEST(Rtp, SkipsOtherExtensionProfiles) {
  const ByteBuffer datagram = from_hex("90600001 00000002 00000003 10000001 13000000 41");
  const auto got = parse_rtp(datagram);
  EXPECT_FALSE(got.value().header.extensions.frame);
  EXPECT_EQ(to_hex(got->payload), "41");
}

TEST(Rtp, StopsAtExtensionIdFifteenAndKeepsWhatCameBefore) {
  const ByteBuffer datagram = from_hex("90600001 00000002 00000003 bede0002 1300000007 ff0000 41");
  const auto got = parse_rtp(datagram);
  EXPECT_EQ(got.value().header.extensions.frame, FrameId{7});
  EXPECT_EQ(to_hex(got->payload), "41");
}

TEST(Rtp, RefusesWhatIsBroken) {
  EXPECT_EQ(parse_rtp(from_hex("40600001 00000002 00000003")).error().code, WireError::kBadVersion);
  EXPECT_EQ(parse_rtp(from_hex("80600001 00000002 000000")).error().code, WireError::kTruncated);
  EXPECT_EQ(parse_rtp(from_hex("8f600001 00000002 00000003")).error().code, WireError::kTruncated);
  EXPECT_EQ(parse_rtp(from_hex("90600001 00000002 00000003 bede0005 00000000")).error().code,
            WireError::kTruncated);
  // Frame id with three octets, an element beyond the block.
  EXPECT_EQ(parse_rtp(from_hex("90600001 00000002 00000003 bede0001 12010203")).error().code,
            WireError::kBadLength);
  EXPECT_EQ(parse_rtp(from_hex("90600001 00000002 00000003 bede0001 00001311")).error().code,
            WireError::kTruncated);
  // Padding of zero, more than there is, and none at all.
  EXPECT_EQ(parse_rtp(from_hex("a0600001 00000002 00000003 4100")).error().code, WireError::kBadLength);
  EXPECT_EQ(parse_rtp(from_hex("a0600001 00000002 00000003 4103")).error().code, WireError::kBadLength);
  EXPECT_EQ(parse_rtp(from_hex("a0600001 00000002 00000003")).error().code, WireError::kBadLength);
}

TEST(Rtp, SurvivesEveryDamage) {
  ByteBuffer out;
  append_rtp_header(full_header(), out);
  out.resize(out.size() + 10, std::byte{0x41});
  test::for_each_damage(out, [](const ByteBuffer& bytes) { static_cast<void>(parse_rtp(bytes)); });
}

TEST(SequenceUnwrapper, FollowsTheWrapBothWays) {
  SequenceUnwrapper unwrapper;
  EXPECT_EQ(unwrapper.unwrap(65534), 65534);
  EXPECT_EQ(unwrapper.unwrap(1), 65537);
  EXPECT_EQ(unwrapper.peek(65535), 65535);
  EXPECT_EQ(unwrapper.unwrap(65535), 65535);
  EXPECT_EQ(unwrapper.unwrap(2), 65538);
  for (std::int64_t i = 65539; i < 300'000; ++i) {
    ASSERT_EQ(unwrapper.unwrap(static_cast<std::uint16_t>(i & 0xFFFF)), i);
  }
}

TEST(SequenceUnwrapper, GoesBelowZeroRatherThanFarAhead) {
  SequenceUnwrapper unwrapper;
  EXPECT_EQ(unwrapper.unwrap(1), 1);
  EXPECT_EQ(unwrapper.unwrap(65535), -1);
  EXPECT_EQ(unwrapper.unwrap(65530), -6);
  EXPECT_EQ(unwrapper.unwrap(0), 0);
}

}  // namespace
}  // namespace atlaswire::proto
