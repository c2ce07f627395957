#pragma once

#include "netsim/emulator.h"

#include <functional>
#include <map>
#include <optional>
#include <vector>

namespace atlaswire::netsim {

/// What an endpoint hands to the network: a datagram, or octets of a reliable stream.
struct Outgoing {
  FlowId flow{};  ///< datagrams and streams have different flows
  bool stream = false;
  ByteBuffer octets;
};

/// One end of a virtual path: a protocol's state machine without sockets or clock.
class Endpoint {
 public:
  virtual ~Endpoint() = default;
  /// Octets of `flow` arrive: one datagram, or the next octets of a stream.
  virtual void receive(FlowId flow, ByteView octets, Time now) = 0;
  /// When `wake` wants to be called; empty: only data matters.
  [[nodiscard]] virtual std::optional<Time> next_deadline() const = 0;
  /// A deadline has come. It must move on: next_deadline() > now, or empty, before long.
  virtual void wake(Time now) = 0;
  /// What there is to send since the last call.
  virtual std::vector<Outgoing> take_outgoing() = 0;
};

/// Runs two endpoints over a path in virtual time: an event queue that jumps from one event to the next.
/// Equal endpoints, profile and seed give equal runs. At one instant scheduled calls come first, then
/// deliveries, then the client's deadline, then the server's.
class VirtualDriver {
 public:
  /// The endpoints are borrowed. `start`: the run's first instant and the profile's zero.
  VirtualDriver(Endpoint& client, Endpoint& server, const Profile& profile, std::uint64_t seed, Time start);

  /// Calls `what` at `at` (not before `now()`); calls for one instant in the order they were scheduled.
  void schedule(Time at, std::function<void(Time)> what);
  /// Everything up to and at `end` happens.
  void run_until(Time end);
  /// Of the event in progress, or of the end of the last run.
  [[nodiscard]] Time now() const { return now_; }
  /// For taps, decisions and counts.
  Emulator& emulator() { return emulator_; }

 private:
  [[nodiscard]] std::optional<Time> next_event() const;
  void step(Time now);
  void collect(Endpoint& from, Direction direction);

  Endpoint& client_;
  Endpoint& server_;
  Emulator emulator_;
  std::multimap<Time, std::function<void(Time)>> scheduled_;
  Time now_;
};

}  // namespace atlaswire::netsim
