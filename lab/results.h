#pragma once

#include "base/result.h"
#include "lab/experiment.h"
#include "lab/plan.h"
#include "lab/store.h"
#include "lab/tables.h"

#include <string>
#include <string_view>
#include <vector>

namespace atlaswire::lab {

/// What a results folder is about: plan.json.
struct StoredPlan {
  ExperimentSource source;
  bool quick = false;
  Experiment experiment;  ///< parsed from `source`
  Plan plan;
};

/// JSON text and back. Errors: kBadRecord, and those of parse_experiment.
std::string to_json(const StoredPlan& stored);
Result<StoredPlan> parse_stored_plan(std::string_view json);

/// Reads ROOT/plan.json. Throws ProgramError(kUsage) when the folder has none.
StoredPlan load_plan(const Store& store);

/// Everything the report is made of, as JSON: experiment, plots, provenance, rows and analysis.
std::string results_json(const StoredPlan& stored, const std::vector<Row>& rows, const Store& store);

/// Writes results.csv, timings.csv, frames.csv and results.json of the points finished so far; gives their
/// rows. Throws ProgramError(kCannotWrite).
std::vector<Row> write_results(const StoredPlan& stored, const Store& store);

}  // namespace atlaswire::lab
