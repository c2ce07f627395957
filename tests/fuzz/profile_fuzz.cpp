#include "base/assert.h"
#include "netsim/emulator.h"
#include "netsim/profile.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace {

/// What parses must also run, whatever its values: a short load both ways, then the end.
void run(const atlaswire::netsim::Profile& profile) {
  using namespace atlaswire;
  netsim::Emulator emulator(profile, 1, Time{});
  std::size_t sent = 0;
  for (int i = 0; i < 40; ++i) {
    const Time now{std::chrono::milliseconds(3) * i};
    for (const auto way : {netsim::Direction::kUp, netsim::Direction::kDown}) {
      for (const std::uint32_t flow : {1U, 2U}) {
        emulator.datagram(netsim::FlowId{flow}, way, ByteBuffer(1200), now, static_cast<netsim::Ecn>(i % 4));
        ++sent;
      }
    }
    for (const netsim::Delivery& d : emulator.deliver(now)) AW_ASSERT(d.arrival <= now);
  }
  emulator.finish();
  std::size_t decided = 0;
  for (const auto& d : emulator.take_decisions()) {
    if (!d.decision.duplicate) ++decided;
    AW_ASSERT(d.decision.left_queue >= d.decision.arrived);
  }
  AW_ASSERT(decided == sent);
}

}  // namespace

/// Profiles are files from anywhere; trace files are not read here, for there is no such directory.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto profile = atlaswire::netsim::parse_profile(text, "fuzz", "/nonexistent");
  if (profile.has_value()) {
    run(*profile);
  } else {
    AW_ASSERT(!profile.error().message().empty());
  }
  return 0;
}
