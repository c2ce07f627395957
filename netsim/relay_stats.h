#pragma once

#include "netsim/lateness.h"
#include "netsim/path.h"

#include <array>
#include <cstdint>
#include <string>

namespace atlaswire::netsim {

/// What a relay did so far.
struct RelayStats {
  struct Way {
    std::uint64_t packets = 0;  ///< that entered, segments of streams included
    std::uint64_t octets = 0;   ///< payload
    std::array<std::uint64_t, 7> packets_by_fate{};
    std::array<std::uint64_t, 7> octets_by_fate{};
    std::uint64_t duplicates = 0;
    std::uint64_t corrupted = 0;
    std::uint64_t reordered = 0;
    std::uint64_t marked = 0;         ///< congestion experienced
    std::uint64_t send_failures = 0;  ///< delivered by the model, refused by the machine's own sockets
  };
  std::array<Way, 2> ways;
  Lateness lateness;  ///< of datagrams: left the relay, against when the model said
  std::uint64_t udp_flows = 0;
  std::uint64_t tcp_connections = 0;
  std::uint64_t flows_refused = 0;  ///< the table was full
  std::uint64_t connect_failures = 0;
  std::uint64_t stream_repeats = 0;

  Way& way(Direction d) { return ways[static_cast<std::size_t>(d)]; }
  [[nodiscard]] const Way& way(Direction d) const { return ways[static_cast<std::size_t>(d)]; }
  void count(const Decision& decision, Direction direction);
};

/// One JSON object, indented.
std::string stats_json(const RelayStats& stats, const std::string& profile, std::uint64_t seed,
                       Duration elapsed);

/// One line for a terminal: what went through since `before`, `elapsed` ago.
std::string stats_line(const RelayStats& now, const RelayStats& before, Duration elapsed);

}  // namespace atlaswire::netsim
