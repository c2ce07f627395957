#include "proto/rtcp.h"

#include "proto/datagram.h"
#include "tests/proto/vocabulary.h"

#include <gtest/gtest.h>

namespace atlaswire::proto {
namespace {

using test::from_hex;
using test::to_hex;

ReportBlock block() { return {0xAABBCCDD, 64, -3, 0x10002, 77, 0x12345678, 65'536}; }

ByteBuffer encoded(const std::vector<RtcpPacket>& packets) {
  ByteBuffer out;
  encode_rtcp(packets, out);
  return out;
}

TEST(Rtcp, GoldenBytesOfASendersCompound) {
  EXPECT_EQ(to_hex(encoded(
                {SenderReport{1, 0x0102030405060708, 90'000, 10, 1000, {}}, SourceDescription{1, "aw@x"}})),
            "80c80006"
            "00000001"
            "0102030405060708"
            "00015f90"
            "0000000a"
            "000003e8"
            "81ca0003"
            "00000001"
            "01"
            "04"
            "61774078"
            "0000");
}

TEST(Rtcp, GoldenBytesOfAReceiversCompound) {
  EXPECT_EQ(to_hex(encoded({ReceiverReport{2, {block()}}, SourceDescription{2, "b"}, PictureLoss{2, 1}})),
            "81c90007"
            "00000002"
            "aabbccdd"
            "40fffffd"
            "00010002"
            "0000004d"
            "12345678"
            "00010000"
            "81ca0002"
            "00000002"
            "01"
            "01"
            "62"
            "00"
            "81ce0002"
            "00000002"
            "00000001");
}

TEST(Rtcp, GoldenBytesOfABye) {
  EXPECT_EQ(to_hex(encoded({ReceiverReport{2, {}}, Bye{2, "done"}})),
            "80c90001"
            "00000002"
            "81cb0003"
            "00000002"
            "04646f6e65"
            "000000");
}

TEST(Rtcp, ComesBackAsSent) {
  const std::vector<RtcpPacket> sent = {SenderReport{1, 2, 3, 4, 5, {block(), block()}},
                                        ReceiverReport{6, {block()}},
                                        SourceDescription{7, std::string(255, 'n')},
                                        PictureLoss{8, 9},
                                        Bye{10, "why"},
                                        Bye{11, ""}};
  EXPECT_EQ(parse_rtcp(encoded(sent)).value(), sent);
}

TEST(Rtcp, NamesOfEveryLengthArePaddedRight) {
  for (std::size_t size = 0; size <= 9; ++size) {
    const std::vector<RtcpPacket> sent = {ReceiverReport{1, {}}, SourceDescription{7, std::string(size, 'n')},
                                          Bye{7, std::string(size, 'r')}};
    const ByteBuffer out = encoded(sent);
    EXPECT_EQ(out.size() % 4, 0U);
    EXPECT_EQ(parse_rtcp(out).value(), sent) << size;
  }
}

TEST(Rtcp, EachIsToldFromRtpByItsFirstOctets) {
  EXPECT_EQ(classify(encoded({SenderReport{}})), DatagramKind::kRtcp);
  EXPECT_EQ(classify(encoded({ReceiverReport{1, {block()}}})), DatagramKind::kRtcp);
}

TEST(Rtcp, CumulativeLossIsClampedToItsField) {
  ReportBlock b = block();
  b.cumulative_lost = 100'000'000;
  const auto got = parse_rtcp(encoded({ReceiverReport{1, {b}}})).value();
  EXPECT_EQ(std::get<ReceiverReport>(got[0]).blocks[0].cumulative_lost, 0x7FFFFF);
}

TEST(Rtcp, SkipsPacketsAndItemsItDoesNotKnow) {
  const auto got =
      parse_rtcp(from_hex("80c90001 00000002"
                          "81cd0002 00000002 00000001"  // RTPFB
                          "84ce0002 00000002 00000001"  // another PSFB
                          "82ca0006 00000005 02 03 616263 01 01 7a 00 000000"
                          "00000006 02 01 61 00"));  // a chunk without CNAME
  ASSERT_TRUE(got.has_value()) << got.error().message();
  ASSERT_EQ(got->size(), 2U);
  EXPECT_EQ(std::get<SourceDescription>((*got)[1]), (SourceDescription{5, "z"}));
}

TEST(Rtcp, TakesPaddingAtTheEndOnly) {
  EXPECT_TRUE(parse_rtcp(from_hex("a0c90002 00000002 00000004")).has_value());
  EXPECT_TRUE(parse_rtcp(from_hex("a0c90002 00000002 00000004 80c90001 00000002")).has_error());
  EXPECT_TRUE(parse_rtcp(from_hex("a0c90002 00000002 00000003")).has_error());
  EXPECT_TRUE(parse_rtcp(from_hex("a0c90002 00000002 0000000c")).has_error());
  EXPECT_TRUE(parse_rtcp(from_hex("a0c90002 00000002 00000000")).has_error());
}

TEST(Rtcp, RefusesWhatIsBroken) {
  const auto code = [](const char* hex) { return parse_rtcp(from_hex(hex)).error().code; };
  EXPECT_EQ(code(""), WireError::kTruncated);
  EXPECT_EQ(code("80c9"), WireError::kTruncated);
  EXPECT_EQ(code("80c90002 00000002"), WireError::kTruncated);  // length beyond the end
  EXPECT_EQ(code("81c90001 00000002"), WireError::kTruncated);  // a block announced, none there
  EXPECT_EQ(code("40c90001 00000002"), WireError::kBadVersion);
  EXPECT_EQ(code("81ce0002 00000002 00000001"), WireError::kBadType);  // no report first
  EXPECT_EQ(code("80c90001 00000002 81ce0001 00000002"), WireError::kTruncated);
  EXPECT_EQ(code("80c90001 00000002 81ca0002 00000005 01ff 6161"), WireError::kTruncated);
  EXPECT_EQ(code("80c90001 00000002 81cb0002 00000005 ff616161"), WireError::kTruncated);
  EXPECT_EQ(code("80c90001 00000002 80"), WireError::kTruncated);
}

TEST(Rtcp, RefusesFloodsOfPackets) {
  std::vector<RtcpPacket> many(65, ReceiverReport{1, {}});
  EXPECT_EQ(parse_rtcp(encoded(many)).error().code, WireError::kBadLength);
  many.pop_back();
  EXPECT_EQ(parse_rtcp(encoded(many)).value().size(), 64U);
}

TEST(Rtcp, SurvivesEveryDamage) {
  const ByteBuffer out = encoded({SenderReport{1, 2, 3, 4, 5, {block()}}, SourceDescription{7, "name"},
                                  PictureLoss{8, 9}, Bye{10, "why"}});
  EXPECT_TRUE(parse_rtcp(out).has_value());
  test::for_each_damage(out, [](const ByteBuffer& bytes) { static_cast<void>(parse_rtcp(bytes)); });
}

}  // namespace
}  // namespace atlaswire::proto
