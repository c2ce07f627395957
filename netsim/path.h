#pragma once

#include "netsim/lane.h"
#include "netsim/profile.h"

#include <algorithm>
#include <array>
#include <optional>

namespace atlaswire::netsim {

/// The earlier of two instants that may not be known.
[[nodiscard]] inline std::optional<Time> earlier(std::optional<Time> a, std::optional<Time> b) {
  return !a || !b ? (a ? a : b) : std::min(*a, *b);
}

/// Both directions of one of a profile's paths. The draws of paths and of directions are independent; each is
/// a function of the seed.
class Path {
 public:
  Path(const Profile& profile, PathId id, std::uint64_t seed, Time start);
  Lane& lane(Direction direction) { return lanes_[static_cast<std::size_t>(direction)]; }
  [[nodiscard]] const Lane& lane(Direction direction) const {
    return lanes_[static_cast<std::size_t>(direction)];
  }
  Link& link(Direction direction) { return lane(direction).link(); }
  [[nodiscard]] std::optional<Time> next_event() const;
  /// When something next comes out, as far as is known; empty: nothing is past the bottleneck.
  [[nodiscard]] std::optional<Time> next_arrival() const;

 private:
  std::array<Lane, 2> lanes_;
};

}  // namespace atlaswire::netsim
