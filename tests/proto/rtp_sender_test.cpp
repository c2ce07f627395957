#include "proto/rtp_sender.h"

#include "tests/proto/vocabulary.h"

#include <gtest/gtest.h>

namespace atlaswire::proto {
namespace {

using test::at;
using namespace std::chrono_literals;

TEST(RtpSender, NumbersStampsAndMarksItsPackets) {
  Random random(1);
  RtpSender::Settings settings;
  settings.ssrc = 42;
  settings.first_sequence = 65530;
  settings.timestamp_base = 1000;
  RtpSender sender(settings);
  DatagramBatch batch;
  std::uint16_t sequence = 65530;
  std::uint16_t transport = 0;
  std::uint32_t octets = 0;
  for (std::uint32_t n = 0; n < 20; ++n) {
    const ByteBuffer unit = test::picture(n == 0, 9000, random);
    sender.packetize({unit, FrameId{n}, PoseId{n + 5}, at(100ms * n), n == 0}, batch);
    ASSERT_GT(batch.size(), 7U);
    EXPECT_EQ(batch.frame, FrameId{n});
    EXPECT_EQ(batch.idr, n == 0);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      ASSERT_LE(batch[i].size(), 1200U);
      const auto packet = parse_rtp(batch[i]).value();
      octets += static_cast<std::uint32_t>(packet.payload.size());
      EXPECT_EQ(packet.header.sequence, sequence++);
      EXPECT_EQ(packet.header.timestamp, 1000 + 9000 * n);
      EXPECT_EQ(packet.header.ssrc, 42U);
      EXPECT_EQ(packet.header.marker, i + 1 == batch.size());
      EXPECT_EQ(packet.header.extensions.frame, FrameId{n});
      EXPECT_EQ(packet.header.extensions.transport_sequence, transport++);
      EXPECT_EQ(packet.header.extensions.pose.has_value(), i == 0);
      EXPECT_EQ(packet.header.extensions.capture.has_value(), i == 0);
      if (i == 0) {
        EXPECT_EQ(packet.header.extensions.pose, PoseId{n + 5});
        EXPECT_EQ(from_ntp(*packet.header.extensions.capture), at(100ms * n));
      }
    }
  }
  EXPECT_EQ(sender.packet_count(), transport);
  EXPECT_EQ(sender.octet_count(), octets);
}

TEST(RtpSender, FillsItsDatagrams) {
  Random random(2);
  RtpSender sender({});
  DatagramBatch batch;
  sender.packetize({test::picture(false, 100'000, random), FrameId{0}, PoseId{0}, at(0s), false}, batch);
  std::size_t full = 0;
  for (std::size_t i = 0; i < batch.size(); ++i) full += batch[i].size() == 1200 ? 1 : 0;
  EXPECT_GE(full + 2, batch.size());
}

TEST(RtpSender, KeepsToSmallerDatagrams) {
  Random random(3);
  RtpSender::Settings settings;
  settings.max_datagram = 100;
  RtpSender sender(settings);
  DatagramBatch batch;
  sender.packetize({test::picture(true, 2000, random), FrameId{0}, PoseId{0}, at(0s), true}, batch);
  for (std::size_t i = 0; i < batch.size(); ++i) EXPECT_LE(batch[i].size(), 100U);
}

TEST(RtpSender, AnEmptyPictureUsesNoNumber) {
  Random random(4);
  RtpSender sender({});
  DatagramBatch batch;
  sender.packetize({{}, FrameId{0}, PoseId{0}, at(0s), true}, batch);
  EXPECT_EQ(batch.size(), 0U);
  sender.packetize({test::picture(true, 50, random), FrameId{1}, PoseId{0}, at(0s), true}, batch);
  EXPECT_EQ(parse_rtp(batch[0]).value().header.sequence, 0);
}

TEST(RtpSender, ReusesTheBatchsMemory) {
  Random random(5);
  RtpSender sender({});
  DatagramBatch batch;
  const ByteBuffer unit = test::picture(true, 30'000, random);
  sender.packetize({unit, FrameId{0}, PoseId{0}, at(0s), true}, batch);
  const auto* octets = batch.octets.data();
  const auto* ends = batch.ends.data();
  sender.packetize({unit, FrameId{1}, PoseId{0}, at(1s), true}, batch);
  EXPECT_EQ(batch.octets.data(), octets);
  EXPECT_EQ(batch.ends.data(), ends);
}

}  // namespace
}  // namespace atlaswire::proto
