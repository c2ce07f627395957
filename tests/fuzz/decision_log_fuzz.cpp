#include "base/assert.h"
#include "netsim/decision_log.h"
#include "netsim/profile.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

/// A log from anywhere: what parses is written the same way again, and can be replayed.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace atlaswire::netsim;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto log = parse_decision_log(text);
  if (!log.has_value()) {
    AW_ASSERT(!log.error().detail.empty());
    return 0;
  }
  std::string again;
  for (DirectedDecision d : *log) {
    if (d.decision.fate != Fate::kDelivered) d.decision.delivered = {};
    again += format_decision(d, atlaswire::Time{}) + '\n';
  }
  AW_ASSERT(parse_decision_log(again).has_value());
  static const Profile profile = *load_profile("lossy-wifi");
  std::size_t packets = 0;
  for (const DirectedDecision& d : *log) packets += d.decision.duplicate ? 0 : 1;
  AW_ASSERT(replay(*log, profile, 1).size() == packets);
  return 0;
}
