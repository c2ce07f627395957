#pragma once

#include "base/program.h"
#include "client/settings.h"

namespace atlaswire::client {

/// A whole run of atlas-client: connects, displays, measures, compares, writes and prints. Gives the exit
/// code of a run that showed something; throws ProgramError for what prevents one.
ExitCode run_viewer(const ClientSettings& settings);

}  // namespace atlaswire::client
