#pragma once

#include "netsim/path.h"
#include "netsim/stream_link.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace atlaswire::netsim {

/// Something comes out at the far end of `direction`.
struct Delivery {
  FlowId flow{};
  Direction direction = Direction::kUp;
  Time arrival{};
  ByteBuffer octets;
};

/// A decision and the direction it was taken in, for logs and for replay.
struct DirectedDecision {
  Direction direction = Direction::kUp;
  Decision decision;
  bool operator==(const DirectedDecision&) const = default;
};

/// All flows of a relay over one path: they share its bottleneck and its air. The core of the live relay and
/// of the virtual-time driver alike: no sockets, no clock. Equal calls give equal decisions, however often
/// `deliver` is called between them.
class Emulator {
 public:
  Emulator(const Profile& profile, std::uint64_t seed, Time start);

  /// A datagram of `flow` enters.
  void datagram(FlowId flow, Direction direction, ByteBuffer octets, Time now);
  /// Octets of a byte stream enter; a flow is either datagrams or a stream. Keep `outstanding` bounded.
  void stream(FlowId flow, Direction direction, ByteView octets, Time now);
  /// Octets of a stream that are still on their way.
  [[nodiscard]] std::size_t outstanding(FlowId flow, Direction direction) const;
  /// Forgets a stream; what is on its way is dropped.
  void close_stream(FlowId flow);

  /// The next instant at which something happens inside; empty: idle until something enters.
  [[nodiscard]] std::optional<Time> next_event() const;
  /// What has come out by `now`, in order of arrival within each direction.
  std::vector<Delivery> deliver(Time now);
  /// When something next comes out, as far as is known; empty: nothing is past the bottleneck.
  [[nodiscard]] std::optional<Time> next_arrival() const;
  /// Octets that streams may add now to the queue of `direction`, which they fill no further than half: the
  /// congestion control that keeps a stream from losing its own segments.
  [[nodiscard]] std::size_t stream_room(Direction direction) const;
  /// The run is over: decides what waits (Link::finish); streams are forgotten.
  void finish();
  /// Decisions since the last call.
  std::vector<DirectedDecision> take_decisions();
  /// `tap` hears of every decision in `direction`.
  void set_tap(Direction direction, Tap* tap) { path_.link(direction).set_tap(tap); }
  /// Segments of streams that had to be sent again.
  [[nodiscard]] std::uint64_t stream_repeats() const { return stream_repeats_; }

 private:
  using Streams = std::map<FlowId, StreamLink>;
  Streams& streams(Direction d) { return streams_[static_cast<std::size_t>(d)]; }
  [[nodiscard]] const Streams& streams(Direction d) const { return streams_[static_cast<std::size_t>(d)]; }
  [[nodiscard]] std::optional<Time> next_of(Direction direction) const;
  void advance(Direction direction, Time now);
  void sort_decisions(Direction direction);
  void hand_out(Direction direction, Datagram datagram);

  Path path_;
  Duration round_trip_;
  std::array<Streams, 2> streams_;
  std::vector<Delivery> out_;
  std::vector<DirectedDecision> decisions_;
  std::uint64_t stream_repeats_ = 0;
};

}  // namespace atlaswire::netsim
