#pragma once

#include "netsim/relay.h"
#include "netsim/relay_recorder.h"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>

namespace atlaswire::netsim {

namespace asio = boost::asio;
using asio::ip::tcp;
using asio::ip::udp;

/// What the relay's halves for UDP and TCP share.
struct RelayContext {
  RelayContext(const RelaySettings& s, Time start, Duration start_unix)
      : settings(s),
        last_now(start),
        recorder(s.log_file, s.pcapng_file, start, start_unix),
        emulator(s.profile, s.seed, start) {
    recorder.attach(emulator);
  }

  /// The steady clock, which the emulator demands never goes back.
  Time now() { return last_now = std::max(last_now, steady_now()); }
  /// A new flow's number, or none when the table is full.
  std::optional<FlowId> open_flow() {
    if (flows >= settings.max_flows) {
      ++stats.flows_refused;
      return std::nullopt;
    }
    ++flows;
    return FlowId{next_flow++};
  }
  void close_flow() { --flows; }

  const RelaySettings& settings;
  Time last_now;
  RelayStats stats;
  RelayRecorder recorder;
  Emulator emulator;
  std::size_t flows = 0;
  std::uint32_t next_flow = 1;
};

}  // namespace atlaswire::netsim
