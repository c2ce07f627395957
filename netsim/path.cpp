#include "netsim/path.h"

#include <algorithm>

namespace atlaswire::netsim {

namespace {

Lane lane_of(const Profile& profile, PathId id, Direction direction, std::uint64_t seed, Time start) {
  constexpr std::uint64_t kGoldenRatio = 0x9E3779B97F4A7C15ULL;
  const std::uint64_t path_seed = seed ^ (static_cast<std::uint64_t>(id) * kGoldenRatio);
  const auto base = [&](Direction d) { return profile.link(id, d).steps[0].parameters.delay.base; };
  return {profile.link(id, direction), path_seed * 2 + static_cast<std::uint64_t>(direction), start,
          base(Direction::kUp) + base(Direction::kDown)};
}

}  // namespace

Path::Path(const Profile& profile, PathId id, std::uint64_t seed, Time start)
    : lanes_{lane_of(profile, id, Direction::kUp, seed, start),
             lane_of(profile, id, Direction::kDown, seed, start)} {}

std::optional<Time> Path::next_event() const {
  return earlier(lanes_[0].next_event(), lanes_[1].next_event());
}

std::optional<Time> Path::next_arrival() const {
  return earlier(lanes_[0].link().next_arrival(), lanes_[1].link().next_arrival());
}

}  // namespace atlaswire::netsim
