#pragma once

#include "base/result.h"
#include "lab/point.h"
#include "lab/point_result.h"

#include <filesystem>
#include <string>
#include <vector>

namespace atlaswire::lab {

/// The command lines of one live point, of programs in `bin`; ports and ready files are the caller's.
struct LiveCommands {
  std::vector<std::string> daemon;
  std::vector<std::string> relay;  ///< empty: no `profile`, straight over loopback
  std::vector<std::string> client;
};

/// What a live run can honour; kOutOfRange names the first setting that it cannot (a latency, a method that
/// is not streamed, stereo, causes switched off), for it would be ignored without a word.
Result<LiveCommands> live_commands(const PointSettings& settings, const std::filesystem::path& bin,
                                   const std::filesystem::path& out);

/// atlas-client's summary.json as timings: stages under [SAS]'s names, rates, quality. Errors: kBadRecord.
Result<std::vector<Figure>> live_timings(const std::string& summary_json);

/// Runs atlasd, atlas-netsim where a profile is set, and atlas-client as processes over loopback. All it
/// gives is `timings`, for nothing of it is the same twice. Throws ProgramError with what the program that
/// failed said.
PointResult run_live(const PointSettings& settings, const PointOutputs& outputs);

}  // namespace atlaswire::lab
