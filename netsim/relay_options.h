#pragma once

#include "netsim/probe.h"
#include "netsim/relay.h"

#include <string>

namespace atlaswire::netsim {

/// What the command line asks for.
struct NetsimOptions {
  enum class Mode { kPrint, kRelay, kReplay, kDraw };
  Mode mode = Mode::kPrint;
  std::string text;  ///< to print
  RelaySettings relay;
  std::string ready_file;
  std::string replay_file;
  std::string draw_file;
  ProbeLoad load;
  bool json = false;
};

/// Throws ProgramError (usage).
NetsimOptions parse_netsim_options(int argc, const char* const* argv);

}  // namespace atlaswire::netsim
