#include "proto/rtcp_stats.h"

#include "tests/proto/vocabulary.h"

#include <gtest/gtest.h>

namespace atlaswire::proto {
namespace {

using test::at;
using namespace std::chrono_literals;

RtpHeader header(std::uint16_t sequence, std::uint32_t timestamp = 0) {
  RtpHeader h;
  h.ssrc = 9;
  h.sequence = sequence;
  h.timestamp = timestamp;
  return h;
}

TEST(ReceptionStats, NothingToReportBeforeTheFirstPacket) {
  ReceptionStats stats;
  EXPECT_FALSE(stats.report(at(0s)));
}

TEST(ReceptionStats, CountsLossesPerIntervalAndInAll) {
  ReceptionStats stats;
  for (std::uint16_t i = 0; i < 100; ++i) {
    if (i % 4 != 1) stats.on_packet(header(i), at(1ms * i));
  }
  auto block = stats.report(at(1s)).value();
  EXPECT_EQ(block.ssrc, 9U);
  EXPECT_EQ(block.fraction_lost, 64);
  EXPECT_EQ(block.cumulative_lost, 25);
  EXPECT_EQ(block.highest_sequence, 99U);
  EXPECT_EQ(block.last_report, 0U);
  for (std::uint16_t i = 100; i < 200; ++i) stats.on_packet(header(i), at(1ms * i));
  block = stats.report(at(2s)).value();
  EXPECT_EQ(block.fraction_lost, 0);
  EXPECT_EQ(block.cumulative_lost, 25);
}

TEST(ReceptionStats, DuplicatesMakeLossesNegativeAsTheRfcHasIt) {
  ReceptionStats stats;
  for (int copy = 0; copy < 2; ++copy) {
    for (std::uint16_t i = 0; i < 10; ++i) stats.on_packet(header(i), at(0s));
  }
  const auto block = stats.report(at(1s)).value();
  EXPECT_EQ(block.fraction_lost, 0);
  EXPECT_EQ(block.cumulative_lost, -10);
}

TEST(ReceptionStats, AllLostInAnIntervalFillsTheField) {
  ReceptionStats stats;
  stats.on_packet(header(0), at(0s));
  stats.report(at(1s));
  stats.on_packet(header(2000), at(1s));
  EXPECT_EQ(stats.report(at(2s)).value().fraction_lost, 255);
}

TEST(ReceptionStats, ExtendsTheSequenceAcrossWraps) {
  ReceptionStats stats;
  for (std::uint32_t i = 65'000; i < 200'000; ++i) {
    stats.on_packet(header(static_cast<std::uint16_t>(i)), at(1us * i));
    if (i % 50 == 0) stats.on_packet(header(static_cast<std::uint16_t>(i - 20)), at(1us * i));  // late copy
  }
  EXPECT_EQ(stats.report(at(1s)).value().highest_sequence, 199'999U);
  EXPECT_EQ(stats.lost(), -2700);
}

TEST(ReceptionStats, EvenSpacingHasNoJitter) {
  ReceptionStats stats;
  for (std::uint16_t i = 0; i < 100; ++i) stats.on_packet(header(i, 900U * i), at(10ms * i));
  EXPECT_EQ(stats.jitter(), Duration{});
}

TEST(ReceptionStats, JitterFollowsA8) {
  // Packets alternate between 0 and 2 ms late: every |D| is 180 ticks, and the filter ends there.
  ReceptionStats stats;
  for (std::uint16_t i = 0; i < 2000; ++i) {
    stats.on_packet(header(i, 900U * i), at(10ms * i + (i % 2) * 2ms));
  }
  EXPECT_NEAR(static_cast<double>(stats.report(at(30s)).value().jitter), 180, 1);
  EXPECT_NEAR(to_ms(stats.jitter()), 2.0, 0.02);
}

TEST(ReceptionStats, TimestampWrapIsNoJitter) {
  ReceptionStats stats;
  for (std::uint16_t i = 0; i < 100; ++i) {
    stats.on_packet(header(i, 0xFFFF'FF00U + 900U * i), at(10ms * i));
  }
  EXPECT_EQ(stats.jitter(), Duration{});
}

TEST(RoundTrip, ComesFromLsrAndDlsr) {
  // The server sends a report at 100 s; the client (another clock) holds it 500 ms; 40 ms of path in all.
  const Time sent = at(100s);
  SenderReport report;
  report.time = to_ntp(sent);
  ReceptionStats stats;
  stats.on_packet(header(0), at(7s));
  stats.on_sender_report(report, at(7s));
  const auto block = stats.report(at(7s + 500ms)).value();
  const auto rtt = round_trip(block, sent + 540ms);
  ASSERT_TRUE(rtt);
  EXPECT_NEAR(to_ms(*rtt), 40, 0.05);
}

TEST(RoundTrip, RefusesNumbersThatCannotBe) {
  ReportBlock block;
  EXPECT_FALSE(round_trip(block, at(1s)));  // no report yet
  block.last_report = middle(to_ntp(at(10s)));
  EXPECT_EQ(round_trip(block, at(10s)), Duration{});
  block.delay_since_last = 65'536;
  EXPECT_FALSE(round_trip(block, at(10s)));
  block.delay_since_last = 0;
  EXPECT_FALSE(round_trip(block, at(80s)));
  EXPECT_TRUE(round_trip(block, at(60s)));
}

TEST(RoundTrip, HoldsAcrossTheWrapOfTheMiddleBits) {
  ReportBlock block;
  block.last_report = middle(to_ntp(at(65'535s + 990ms)));
  EXPECT_NEAR(to_ms(round_trip(block, at(65'536s + 10ms)).value()), 20, 0.05);
}

}  // namespace
}  // namespace atlaswire::proto
