#pragma once

#include "netsim/path.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace atlaswire::netsim {

/// Something comes out at the far end of `direction`.
struct Delivery {
  FlowId flow{};
  Direction direction = Direction::kUp;
  Time arrival{};
  ByteBuffer octets;
  Ecn ecn{};  ///< of a datagram, as it leaves
};

/// A decision, and the direction and the path it was taken in, for logs and for replay.
struct DirectedDecision {
  Direction direction = Direction::kUp;
  Decision decision;
  PathId path{};
  bool operator==(const DirectedDecision&) const = default;
};

/// All flows of a relay. They share one path, its bottleneck and its air, but for those that the profile
/// gives a path of their own. The core of the live relay and of the virtual-time driver alike: no sockets, no
/// clock. Equal calls give equal decisions, however often `deliver` is called between them.
class Emulator {
 public:
  Emulator(const Profile& profile, std::uint64_t seed, Time start);

  /// A datagram of `flow` enters.
  void datagram(FlowId flow, Direction direction, ByteBuffer octets, Time now, Ecn ecn = Ecn::kNotCapable);
  /// Octets of a byte stream enter; a flow is either datagrams or a stream. Keep `outstanding` bounded.
  void stream(FlowId flow, Direction direction, ByteView octets, Time now);
  /// Octets of a stream that are still on their way.
  [[nodiscard]] std::size_t outstanding(FlowId flow, Direction direction) const;
  /// Forgets a stream; what is on its way is dropped.
  void close_stream(FlowId flow);

  /// The next instant at which something happens inside; empty: idle until something enters.
  [[nodiscard]] std::optional<Time> next_event() const;
  /// What has come out by `now`, in order of arrival within each direction of a path.
  std::vector<Delivery> deliver(Time now);
  /// When something next comes out, as far as is known; empty: nothing is past the bottleneck.
  [[nodiscard]] std::optional<Time> next_arrival() const;
  /// Octets that a stream may add now to the queue of `direction`, which streams fill no further than half:
  /// the congestion control that keeps a stream from losing its own segments.
  [[nodiscard]] std::size_t stream_room(FlowId flow, Direction direction) const;
  /// The run is over: decides what waits (Link::finish); streams are forgotten.
  void finish();
  /// Decisions since the last call.
  std::vector<DirectedDecision> take_decisions();
  /// Of the profile, at least 1: PathId{0} and up.
  [[nodiscard]] std::uint32_t paths() const { return static_cast<std::uint32_t>(paths_.size()); }
  /// `tap` hears of every decision in `direction` of `path`, which there must be.
  void set_tap(PathId path, Direction direction, Tap* tap) { at(path).link(direction).set_tap(tap); }
  /// Segments of streams that had to be sent again.
  [[nodiscard]] std::uint64_t stream_repeats() const;

 private:
  Path& at(PathId path) { return paths_[static_cast<std::size_t>(path)]; }
  Lane& lane(FlowId flow, FlowKind kind, Direction direction);
  [[nodiscard]] const Lane& lane(FlowId flow, FlowKind kind, Direction direction) const;

  Profile profile_;
  std::vector<Path> paths_;
};

}  // namespace atlaswire::netsim
