#include "netsim/pcapng.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace atlaswire::netsim {
namespace {

/// Little-endian, as the file is.
std::uint32_t word(const ByteBuffer& bytes, std::size_t at) {
  std::uint32_t v = 0;
  for (std::size_t i = 4; i-- > 0;) v = v << 8U | std::to_integer<std::uint32_t>(bytes.at(at + i));
  return v;
}

DirectedDecision sample() {
  DirectedDecision d{Direction::kDown, {.packet = 7, .flow = FlowId{2}, .size = 5}};
  d.decision.arrived = Time{std::chrono::milliseconds(10)};
  d.decision.left_queue = Time{std::chrono::microseconds(10'300)};
  d.decision.delivered = Time{std::chrono::microseconds(31'250)};
  return d;
}

TEST(Pcapng, OpensWithASectionAndTwoNanosecondInterfaces) {
  const ByteBuffer opening = pcapng_opening();
  EXPECT_EQ(word(opening, 0), 0x0A0D0D0AU);
  EXPECT_EQ(word(opening, 8), 0x1A2B3C4DU);
  std::size_t at = word(opening, 4);
  EXPECT_EQ(word(opening, at - 4), at) << "a block's length is repeated at its end";
  for (const char* name : {"up", "down"}) {
    EXPECT_EQ(word(opening, at), 1U);
    EXPECT_EQ(word(opening, at + 8), 101U) << "raw IP";
    EXPECT_EQ(std::memcmp(&opening.at(at + 20), name, std::strlen(name)), 0);
    const std::size_t resolution = at + 20 + 4;
    EXPECT_EQ(word(opening, resolution), 0x00010009U);
    EXPECT_EQ(opening.at(resolution + 4), std::byte{9});
    at += word(opening, at + 4);
  }
  EXPECT_EQ(at, opening.size());
}

TEST(Pcapng, APacketCarriesItsDecisionAsAComment) {
  ByteBuffer payload(5, std::byte{0xAB});
  const ByteBuffer block = pcapng_packet(sample(), payload, false, 0x1122334455667788ULL);
  EXPECT_EQ(word(block, 0), 6U);
  EXPECT_EQ(word(block, 4), block.size());
  EXPECT_EQ(word(block, block.size() - 4), block.size());
  EXPECT_EQ(word(block, 8), 1U) << "interface: down";
  EXPECT_EQ(word(block, 12), 0x11223344U);
  EXPECT_EQ(word(block, 16), 0x55667788U);
  EXPECT_EQ(word(block, 20), 33U) << "20 IPv4, 8 UDP, 5 payload";
  std::uint32_t sum = 0;
  for (std::size_t i = 28; i < 48; i += 2) {
    sum += std::to_integer<std::uint32_t>(block[i]) << 8U | std::to_integer<std::uint32_t>(block[i + 1]);
  }
  EXPECT_EQ((sum & 0xFFFFU) + (sum >> 16U), 0xFFFFU) << "the header's checksum holds";
  EXPECT_EQ(block.at(28 + 9), std::byte{17});
  EXPECT_EQ(block.at(28 + 32), std::byte{0xAB});
  const std::string text(reinterpret_cast<const char*>(block.data()), block.size());
  EXPECT_NE(text.find("down packet 7, flow 2: delivered after 21.250 ms, 0.300 ms of it in the queue"),
            std::string::npos);
}

TEST(Pcapng, WordsForEveryFate) {
  DirectedDecision d = sample();
  d.decision.fate = Fate::kExpired;
  d.decision.corrupted = d.decision.duplicate = d.decision.marked = d.decision.reordered = true;
  EXPECT_EQ(describe(d),
            "down packet 7, flow 2: expired after 0.300 ms in the queue, a copy, one bit flipped, marked "
            "congestion experienced, free to overtake");
  d = sample();
  d.decision.fate = Fate::kQueueFull;
  d.decision.left_queue = d.decision.arrived;
  EXPECT_EQ(describe(d), "down packet 7, flow 2: queue_full");
}

TEST(Pcapng, NothingExceedsAnIpPacket) {
  const ByteBuffer block = pcapng_packet(sample(), ByteBuffer(65'535), true, 0);
  EXPECT_EQ(word(block, 20), 65'535U);
  EXPECT_EQ(block.at(28 + 9), std::byte{253});
  EXPECT_EQ(block.size() % 4, 0U);
}

}  // namespace
}  // namespace atlaswire::netsim
