#pragma once

#include "netsim/link.h"

#include <array>
#include <optional>
#include <vector>

namespace atlaswire::netsim {

/// Which way a packet goes.
enum class Direction : std::uint8_t { kUp = 0, kDown = 1 };

/// Both directions of a profile. The directions' draws are independent; each is a function of the seed.
class Path {
 public:
  Path(const Profile& profile, std::uint64_t seed, Time start);
  Link& link(Direction direction) { return links_[static_cast<std::size_t>(direction)]; }
  [[nodiscard]] const Link& link(Direction direction) const {
    return links_[static_cast<std::size_t>(direction)];
  }
  [[nodiscard]] std::optional<Time> next_event() const;

 private:
  std::array<Link, 2> links_;
};

}  // namespace atlaswire::netsim
