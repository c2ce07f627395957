#include "proto/rtcp_stats.h"

#include <algorithm>
#include <cstdlib>

namespace atlaswire::proto {

void ReceptionStats::on_packet(const RtpHeader& header, Time arrival) {
  const std::int64_t sequence = unwrapper_.peek(header.sequence);
  const std::uint32_t transit = to_rtp_time(arrival, 0) - header.timestamp;
  if (!started_) {
    started_ = true;
    ssrc_ = header.ssrc;
    base_ = highest_ = sequence;
  } else {
    const auto d = static_cast<std::int32_t>(transit - transit_);
    const auto distance = static_cast<std::uint64_t>(std::abs(std::int64_t{d}));
    jitter_16_ += distance - ((jitter_16_ + 8) >> 4U);  // RFC 3550 A.8
  }
  transit_ = transit;
  ++received_;
  if (sequence >= highest_) {
    highest_ = sequence;
    unwrapper_.unwrap(header.sequence);
  }
}

void ReceptionStats::on_sender_report(const SenderReport& report, Time arrival) {
  report_time_ = report.time;
  report_arrival_ = arrival;
}

std::uint64_t ReceptionStats::expected() const {
  return started_ ? static_cast<std::uint64_t>(highest_ - base_ + 1) : 0;
}

std::int64_t ReceptionStats::lost() const {
  return static_cast<std::int64_t>(expected()) - static_cast<std::int64_t>(received_);
}

Duration ReceptionStats::jitter() const {
  return Duration{static_cast<std::int64_t>(jitter_16_ / 16 * 100'000 / 9)};
}

std::optional<ReportBlock> ReceptionStats::report(Time now) {
  if (!started_) return std::nullopt;
  ReportBlock block;
  block.ssrc = ssrc_;
  const auto expected_now = static_cast<std::int64_t>(expected() - expected_before_);
  const auto received_now = static_cast<std::int64_t>(received_ - received_before_);
  expected_before_ = expected();
  received_before_ = received_;
  const std::int64_t lost_now = expected_now - received_now;
  if (expected_now > 0 && lost_now > 0) {  // A.3; all lost would be 256/256: the field's top is 255
    block.fraction_lost =
        static_cast<std::uint8_t>(std::min<std::int64_t>(lost_now * 256 / expected_now, 255));
  }
  block.cumulative_lost = static_cast<std::int32_t>(std::clamp<std::int64_t>(lost(), -0x800000, 0x7FFFFF));
  block.highest_sequence = static_cast<std::uint32_t>(highest_);
  block.jitter = static_cast<std::uint32_t>(jitter_16_ / 16);
  if (report_arrival_) {
    block.last_report = middle(report_time_);
    block.delay_since_last = middle(to_ntp(Time{now - *report_arrival_}));
  }
  return block;
}

std::optional<Duration> round_trip(const ReportBlock& block, Time now) {
  if (block.last_report == 0) return std::nullopt;
  const auto units =
      static_cast<std::int32_t>(middle(to_ntp(now)) - block.last_report - block.delay_since_last);
  constexpr std::int32_t kMinute = 60 * 65'536;
  constexpr std::int32_t kRounding = 2;  // the three terms are rounded down to 15 us each
  if (units < -kRounding || units > kMinute) return std::nullopt;
  return Duration{std::int64_t{std::max(units, 0)} * 1'000'000'000 / 65'536};
}

}  // namespace atlaswire::proto
