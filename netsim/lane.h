#pragma once

#include "netsim/link.h"
#include "netsim/stream_link.h"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace atlaswire::netsim {

/// One direction of a path with the byte streams that cross it beside datagrams: a link whose losses in
/// streams are repeated. No sockets, no clock; equal calls give equal decisions, however often `advance` is
/// called.
class Lane {
 public:
  /// `round_trip`: of the unloaded path, after which a stream's sender notices its first loss.
  Lane(const LinkProfile& profile, std::uint64_t seed, Time start, Duration round_trip);

  /// A datagram of `flow` enters.
  void datagram(FlowId flow, ByteBuffer octets, Time now, Ecn ecn);
  /// Octets of a byte stream enter; a flow is either datagrams or a stream.
  void stream(FlowId flow, ByteView octets, Time now);
  /// Octets of a stream that are still on their way.
  [[nodiscard]] std::size_t outstanding(FlowId flow) const;
  /// Octets that a stream may add now: it fills the queue no further than half.
  [[nodiscard]] std::size_t stream_room() const;
  /// Forgets a stream; what is on its way is dropped.
  void close_stream(FlowId flow) { streams_.erase(flow); }

  /// The next instant at which something happens inside; empty: idle until something enters.
  [[nodiscard]] std::optional<Time> next_event() const;
  /// Everything up to and at `now` happens.
  void advance(Time now);
  /// The run is over: decides what waits (Link::finish); streams are forgotten.
  void finish();
  /// What has come out since the last call, in order of arrival: datagrams, and octets of streams in order.
  std::vector<Datagram> take_arrived();
  /// Decisions since the last call.
  std::vector<Decision> take_decisions();
  /// Segments of streams that had to be sent again.
  [[nodiscard]] std::uint64_t repeats() const { return repeats_; }
  Link& link() { return link_; }
  [[nodiscard]] const Link& link() const { return link_; }

 private:
  void sort_decisions();
  void hand_out(Datagram datagram);

  Link link_;
  Duration round_trip_;
  std::map<FlowId, StreamLink> streams_;
  std::vector<Datagram> arrived_;
  std::vector<Decision> decisions_;
  std::uint64_t repeats_ = 0;
};

}  // namespace atlaswire::netsim
