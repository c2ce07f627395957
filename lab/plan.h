#pragma once

#include "base/result.h"
#include "lab/experiment.h"
#include "lab/point.h"

#include <cstdint>
#include <string>
#include <vector>

namespace atlaswire::lab {

/// What the command line changes about an experiment.
struct PlanRequest {
  bool quick = false;
  /// `key=value` or `key=a,b,c`: replaces the axis of that key, or the setting. Later ones win.
  std::vector<std::string> set;
  std::vector<std::string> only;    ///< names of the variants to keep; empty: all
  std::vector<SceneChoice> scenes;  ///< instead of the experiment's; an empty path means the scene's own
  std::string folder;               ///< where files named by the experiment are looked for first
};

/// One run to make.
struct PlannedPoint {
  /// 16 hex digits: a hash of all settings, and of the content of the files they name. Equal on every machine
  /// that has these files under these names.
  std::string id;
  std::string variant;  ///< empty: the experiment has none
  std::string varied;   ///< of `around`: the key that differs from the base; empty: none
  PointSettings settings;
};

/// All points of an experiment in a fixed order: scenes, variants, sweep axes (the last one fastest), around.
struct Plan {
  std::vector<PlannedPoint> points;
  std::vector<std::string> varying;  ///< keys with more than one value among the points, in order of keys()
  std::vector<std::string> telling;  ///< of them, those that differ within a variant
};

/// Multiplies out. Errors are one line: a value out of range, settings that exclude each other, a scene, path
/// or profile that is not there, more than 100000 points.
Result<Plan> make_plan(const Experiment& experiment, const PlanRequest& request);

/// The plan of these points.
Plan plan_of(std::vector<PlannedPoint> points);

/// "SAS 4 MPix, latency_ms 100": what tells the point from the others of its plan; of keys that `around`
/// changes only the one that it changed.
std::string label(const PlannedPoint& point, const Plan& plan);

/// "latency_ms 100, seed 2".
std::string settings_text(const PointSettings& settings, const std::vector<std::string>& keys);

/// FNV-1a over a text, 64 bits, as 16 hex digits.
std::string text_hash(std::string_view text);

}  // namespace atlaswire::lab
