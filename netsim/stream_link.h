#pragma once

#include "netsim/link.h"

#include <cstdint>
#include <deque>
#include <map>
#include <optional>

namespace atlaswire::netsim {

/// What a reliable byte stream would see on a link: octets come in order, late rather than never. The
/// stream is cut into segments; one that the link loses is sent again, first after a round trip (fast
/// retransmit), then after 200 ms doubling to 3.2 s (RFC 6298's way), and all behind it wait. Congestion
/// control is not modelled: the sender's own kernel does that on its side of the relay.
class StreamLink {
 public:
  static constexpr std::size_t kSegmentOctets = 1448;

  /// `round_trip`: of the unloaded path.
  StreamLink(FlowId flow, Duration round_trip) : flow_(flow), round_trip_(round_trip) {}

  /// Octets enter at `now`, as segments through `link`, which other flows may share.
  void send(ByteView octets, Link& link, Time now);
  /// A decision about one of this stream's packets. A drop schedules a repeat.
  void decided(const Decision& decision);
  /// A segment has come out of the link.
  void arrived(const Datagram& datagram);
  /// Repeats that are due go into `link`.
  void repeat(Link& link, Time now);
  [[nodiscard]] std::optional<Time> next_repeat() const;
  /// Octets that are in order by now.
  ByteBuffer take();
  /// Octets sent and not yet taken: bound what you send by it.
  [[nodiscard]] std::size_t outstanding() const { return outstanding_; }
  [[nodiscard]] std::uint64_t repeats() const { return repeats_; }

 private:
  struct Segment {
    ByteBuffer octets;
    std::uint32_t tries = 0;
  };
  void launch(std::uint64_t segment, Link& link, Time now);

  FlowId flow_;
  Duration round_trip_;
  std::uint64_t next_segment_ = 0;
  std::uint64_t next_in_order_ = 0;
  std::map<std::uint64_t, Segment> unacknowledged_;           ///< by segment number
  std::map<std::uint64_t, std::uint64_t> segment_of_packet_;  ///< link's packet number to segment
  std::multimap<Time, std::uint64_t> due_;                    ///< repeats, by time
  std::map<std::uint64_t, ByteBuffer> early_;                 ///< arrived ahead of a gap
  ByteBuffer ready_;
  std::size_t outstanding_ = 0;
  std::uint64_t repeats_ = 0;
};

}  // namespace atlaswire::netsim
