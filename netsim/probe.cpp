#include "netsim/probe.h"

#include "base/assert.h"
#include "netsim/decision_log.h"

namespace atlaswire::netsim {

std::vector<DirectedDecision> probe(const Profile& profile, std::uint64_t seed, const ProbeLoad& load) {
  AW_ASSERT(load.rate.bits_per_second > 0);
  Emulator emulator(profile, seed, Time{});
  const double gap =
      static_cast<double>(load.packet_octets) * 8 / static_cast<double>(load.rate.bits_per_second);
  std::vector<DirectedDecision> out;
  const auto collect = [&](Time now) {
    (void)emulator.deliver(now);
    for (const DirectedDecision& d : emulator.take_decisions()) out.push_back(d);
  };
  for (std::uint64_t i = 0;; ++i) {
    const Time now{from_seconds(static_cast<double>(i) * gap)};
    if (now.time_since_epoch() >= load.length) break;
    for (const Direction way : {Direction::kUp, Direction::kDown}) {
      emulator.datagram(FlowId{1}, way, ByteBuffer(load.packet_octets), now);
    }
    collect(now);
  }
  emulator.finish();
  for (const DirectedDecision& d : emulator.take_decisions()) out.push_back(d);
  for (DirectedDecision& d : out) {
    if (d.decision.fate != Fate::kDelivered) d.decision.delivered = Time{};
  }
  sort_log(out);
  return out;
}

}  // namespace atlaswire::netsim
