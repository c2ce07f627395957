#pragma once

#include "lab/plan.h"
#include "lab/store.h"

#include <string>
#include <vector>

namespace atlaswire::lab {

/// A planned point and what it gave.
struct Row {
  PlannedPoint point;
  PointRecord record;
};

/// The rows of a plan whose points are finished, in the plan's order. Throws ResultError for a broken record.
std::vector<Row> load_rows(const Plan& plan, const Store& store);

/// A number as tables show it: seven digits, whole numbers whole, NaN empty.
std::string cell(double value);

/// One line a point: id, variant, varied, the plan's varying settings, then every figure that any point has.
/// Only what equal settings make equal, so two runs give the same bytes.
std::string results_csv(const Plan& plan, const std::vector<Row>& rows);
/// The same with timings and the point's own wall clock, which differ from run to run.
std::string timings_csv(const Plan& plan, const std::vector<Row>& rows);
/// One line a measured frame.
std::string frames_csv(const Plan& plan, const std::vector<Row>& rows);

/// A point's figure, timing or numeric setting, in this order of precedence; NaN: it has none of that name.
double number_of(const Row& row, const std::string& name);
/// As text: "variant", a setting, or a number as `cell` shows it.
std::string text_of(const Row& row, const std::string& name);

}  // namespace atlaswire::lab
