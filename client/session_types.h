#pragma once

#include "base/emphasis.h"
#include "base/time.h"
#include "proto/frame_assembler.h"
#include "proto/messages.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace atlaswire::client {

/// How a session presents itself and when it loses patience.
struct SessionSettings {
  proto::ClientHello hello;
  std::optional<Emphasis> emphasis;  ///< said `emphasis_after` the server's answer
  Duration emphasis_after{};
  std::uint32_t ssrc = 1;                               ///< of our RTCP; random
  std::string cname = "atlas-client";                   ///< of our RTCP
  Duration answer_timeout = std::chrono::seconds(10);   ///< from the hello to the answer
  Duration datagram_timeout = std::chrono::seconds(5);  ///< from the answer to the first datagram
  Duration silence_timeout = std::chrono::seconds(5);   ///< without a byte from the server
  Duration report_interval = std::chrono::seconds(1);   ///< RTCP and StatsReport
  Duration pli_round_trip_floor =
      std::chrono::milliseconds(20);  ///< repeats of a PLI wait twice this or more
  proto::FrameAssembler::Settings assembler;
};

/// A meta update as it arrived.
struct ArrivedUpdate {
  proto::FrameMeta meta;
  Time arrival{};
  std::size_t octets = 0;  ///< on the wire
};

/// What the viewer tells the server in its StatsReport.
struct Progress {
  FrameId newest_frame{};
  std::uint64_t paired = 0;
  std::uint64_t displayed = 0;
  double display_rate = 0;      ///< Hz
  Duration motion_to_photon{};  ///< median since the last report
};

}  // namespace atlaswire::client
