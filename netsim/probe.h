#pragma once

#include "base/units.h"
#include "netsim/emulator.h"

#include <vector>

namespace atlaswire::netsim {

/// A load of equal packets at equal distances, both ways at once: what a profile is drawn with.
struct ProbeLoad {
  BitRate rate{20'000'000};  ///< of payload octets, each way; > 0
  std::uint32_t packet_octets = 1200;
  Duration length = std::chrono::seconds(10);
};

/// Runs the load through the profile in virtual time, starting at Time{}: every decision, as `sort_log` has
/// it.
std::vector<DirectedDecision> probe(const Profile& profile, std::uint64_t seed, const ProbeLoad& load);

}  // namespace atlaswire::netsim
