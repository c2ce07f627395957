#pragma once

#include "base/time.h"
#include "proto/datagram.h"

#include <cstdint>
#include <deque>
#include <optional>

namespace atlaswire::proto {

/// Server's part of the exchange.
SyncResponse answer_sync(const SyncRequest& request, Time received, Time sent);

/// Client: estimates the server's clock by four-timestamp exchanges (RFC 5905 section 8): of the exchanges in
/// a window the one with the least round trip counts. Deterministic: no clock, no chance.
class ClockSync {
 public:
  struct Settings {
    Duration fast_interval = std::chrono::milliseconds(50);  ///< until `fast_count` answers came
    std::uint32_t fast_count = 8;
    Duration interval = std::chrono::seconds(1);
    Duration window = std::chrono::seconds(30);
    double max_drift = 100e-6;  ///< relative rate error of two clocks, for the bound
  };

  explicit ClockSync(SessionId session) : ClockSync(session, Settings{}) {}
  ClockSync(SessionId session, const Settings& settings) : session_(session), settings_(settings) {}

  /// The request to send now, or nullopt. Call when next_deadline() is reached.
  std::optional<SyncRequest> poll(Time now);
  /// When to call `poll` next; Time{} before the first call (at once).
  [[nodiscard]] Time next_deadline() const { return next_; }
  /// False when the response answers no request of ours, was answered already, or its times are impossible
  /// (client time running backwards, a negative round trip).
  bool on_response(const SyncResponse& response, Time received);

  [[nodiscard]] bool is_synchronized() const { return !samples_.empty(); }
  /// Server clock minus client clock; 0 before the first exchange.
  [[nodiscard]] Duration offset() const;
  /// Least round trip in the window, without the server's own delay; 0 before the first exchange.
  [[nodiscard]] Duration round_trip() const;
  /// Round trip of the newest exchange.
  [[nodiscard]] Duration last_round_trip() const;
  /// How far `offset` may be off at `now`: half the round trip, plus drift since; Duration::max() before.
  [[nodiscard]] Duration error_bound(Time now) const;
  /// Between the clocks.
  [[nodiscard]] std::int64_t to_server(Time client) const;
  [[nodiscard]] Time to_client(std::int64_t server_nanos) const;

 private:
  struct Sample {
    Time received;
    Duration offset;
    Duration round_trip;
  };
  struct Pending {
    std::uint32_t sequence;
    std::int64_t sent;
  };
  [[nodiscard]] const Sample* best() const;

  SessionId session_;
  Settings settings_;
  Time next_{};
  std::uint32_t sequence_ = 0;
  std::uint32_t answers_ = 0;
  std::deque<Pending> pending_;
  std::deque<Sample> samples_;
};

}  // namespace atlaswire::proto
