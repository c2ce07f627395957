#pragma once

#include "base/program.h"
#include "lab/options.h"

namespace atlaswire::lab {

/// `atlas-lab run`: plans, runs what is missing, writes tables and report. kInternal: points failed;
/// kInterrupted: finished ones are kept. Throws ProgramError.
ExitCode run_experiment(const RunOptions& options);

/// `atlas-lab plan`: one shell command a point on stdout.
void print_plan(const RunOptions& options);

/// `atlas-lab merge` and `report`. Throw ProgramError.
void merge_folders(const std::vector<std::filesystem::path>& sources, const std::filesystem::path& out,
                   bool force);
void report_folder(const std::filesystem::path& folder);

}  // namespace atlaswire::lab
