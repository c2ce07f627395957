#include "netsim/path.h"

#include <algorithm>

namespace atlaswire::netsim {

Path::Path(const Profile& profile, std::uint64_t seed, Time start)
    : links_{Link(profile.up, seed * 2, start), Link(profile.down, seed * 2 + 1, start)} {}

std::optional<Time> Path::next_event() const {
  const auto up = links_[0].next_event();
  const auto down = links_[1].next_event();
  if (!up || !down) return up ? up : down;
  return std::min(*up, *down);
}

}  // namespace atlaswire::netsim
