#pragma once

#include "client/decode_thread.h"
#include "client/display_loop.h"
#include "client/network_thread.h"
#include "client/report.h"

namespace atlaswire::client {

/// What the threads of a run left behind.
struct RunFacts {
  NetworkSnapshot measured_from;  ///< at the end of the warm-up
  NetworkSnapshot measured_to;    ///< when the display loop ended
  DecodeCounts decoded;
  DisplayOutcome display;
};

/// Rates, sums and percentiles of a run into `report`, which knows its settings and stream already.
void fill_report(const RunFacts& facts, RunReport& report);

}  // namespace atlaswire::client
