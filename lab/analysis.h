#pragma once

#include "lab/experiment.h"
#include "lab/tables.h"

#include <string>
#include <vector>

namespace atlaswire::lab {

/// Where a variant's curve meets the reference's.
struct Crossover {
  std::string group;    ///< scene and other settings that the curves share; empty: none vary
  std::string variant;  ///< the other method
  /// Along x, ascending, between measured values by linear interpolation: here the reference starts to be the
  /// better one (`rises`) or ceases to be.
  struct At {
    double x = 0;
    bool rises = false;
  };
  std::vector<At> at;
  bool reference_first = false;  ///< the reference is better at the smallest x
};

/// Bjontegaard's differences of one variant against the reference.
struct RateDifference {
  std::string group;
  std::string variant;
  double rate_percent = 0;  ///< more bytes for equal quality; NaN: see `why`
  double quality = 0;       ///< better at equal bytes, in units of quality; NaN: see `why`
  std::string why;          ///< empty, or why there is no figure
};

/// One variant beside the reference at one scene and set of settings.
struct Difference {
  std::string group;    ///< scene and other settings that both share; empty: none vary
  std::string variant;  ///< the reference itself comes first
  std::string y;
  double value = 0;  ///< the variant's
  double more = 0;   ///< than the reference has; 0 of itself, NaN where the reference has no number
};

/// A recommended point.
struct Advice {
  std::string client;
  std::string id;     ///< empty: no point keeps all limits
  std::string label;  ///< of that point
};

/// Whatever the experiment asks for.
struct Analysis {
  std::vector<Crossover> crossovers;
  std::vector<RateDifference> rates;
  std::vector<Difference> differences;
  std::vector<std::string> front;  ///< ids of Pareto-optimal points, in the plan's order
  std::vector<Advice> advice;
};

/// Curves are made of the rows that share every varying setting but x and what variants set; a row without a
/// number takes no part.
Analysis analyse(const Experiment& experiment, const Plan& plan, const std::vector<Row>& rows);

}  // namespace atlaswire::lab
