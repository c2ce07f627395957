#pragma once

#include "base/time.h"
#include "proto/ntp_time.h"
#include "proto/rtcp.h"
#include "proto/rtp.h"

#include <cstdint>
#include <optional>

namespace atlaswire::proto {

/// Receiver's statistics of one source: sequence extension as RFC 3550 A.1 (without probation: the address
/// is proven), losses A.3, jitter A.8.
class ReceptionStats {
 public:
  /// A packet of the source arrived, in whatever order, duplicates included.
  void on_packet(const RtpHeader& header, Time arrival);
  /// The source's newest sender report arrived.
  void on_sender_report(const SenderReport& report, Time arrival);
  /// The block to send now; starts the next interval of `fraction_lost`. nullopt before the first packet.
  std::optional<ReportBlock> report(Time now);

  [[nodiscard]] std::uint64_t received() const { return received_; }
  /// Expected minus received since the start; negative with duplicates.
  [[nodiscard]] std::int64_t lost() const;
  [[nodiscard]] Duration jitter() const;

 private:
  [[nodiscard]] std::uint64_t expected() const;

  SequenceUnwrapper unwrapper_;
  std::uint32_t ssrc_ = 0;
  bool started_ = false;
  std::int64_t base_ = 0;
  std::int64_t highest_ = 0;
  std::uint64_t received_ = 0;
  std::uint64_t expected_before_ = 0;
  std::uint64_t received_before_ = 0;
  std::uint32_t transit_ = 0;
  std::uint64_t jitter_16_ = 0;  ///< 16 times the jitter, as A.8 keeps it
  NtpTime report_time_ = 0;
  std::optional<Time> report_arrival_;
};

/// Sender's round trip from a block: now - LSR - DLSR (RFC 3550 section 6.4.1); nullopt without LSR or when
/// the peer's numbers make it negative or longer than a minute.
std::optional<Duration> round_trip(const ReportBlock& block, Time now);

}  // namespace atlaswire::proto
