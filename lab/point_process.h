#pragma once

#include "base/program.h"
#include "lab/plan.h"
#include "lab/point_result.h"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace atlaswire::lab {

/// What measures one point: run_point, run_live, or a stand-in of the tests.
using PointRunner = std::function<PointResult(const PointSettings&, const PointOutputs&)>;

/// A point's id and settings as JSON, and back. Errors: kBadRecord, or those of the keys.
std::string settings_json(const PlannedPoint& point);
Result<PlannedPoint> parse_settings_json(std::string_view json);

/// `atlas-lab point`: one point in this process.
struct PointJob {
  std::filesystem::path settings;  ///< file of settings_json()
  std::filesystem::path out;       ///< existing folder for pictures and result.json
  std::filesystem::path truth;     ///< folder that points share; empty: none
};

/// Runs it, saying "progress 0.25" on standard output, and writes result.json last. Ends with its parent.
/// Throws ProgramError; gives kInterrupted after SIGINT or SIGTERM, without a result.
ExitCode run_point_job(const PointJob& job, const PointRunner& runner);

}  // namespace atlaswire::lab
