#pragma once

#include "base/result.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace atlaswire::lab {

/// A key of lab/keys.h and its value as text, both checked.
using Assignment = std::pair<std::string, std::string>;

/// One key and the values it takes in turn.
struct Axis {
  std::string key;
  std::vector<std::string> values;
};

/// Settings that go together, under the name that tables and legends show.
struct Variant {
  std::string name;
  std::vector<Assignment> settings;
};

/// One scene and the path through it.
struct SceneChoice {
  std::string scene;
  std::string path;
};

/// One picture of the report. Names are keys, figures or timings of points, or "variant".
struct Plot {
  enum class Kind { kLine, kBars, kStack, kScatter };
  Kind kind = Kind::kLine;
  std::string title;
  std::string x;               ///< kBars, kStack: what tells the bars apart
  std::vector<std::string> y;  ///< kStack: the parts of a bar, from the axis; others: one picture each
  std::string series = "variant";
  std::string x_label;  ///< empty: `x`
  std::string y_label;  ///< empty: each `y`
  bool log_x = false;
};

/// Where each other variant falls below (or rises above) `reference` along `x`.
struct CrossoverRule {
  std::string x;
  std::string y;
  std::string reference;  ///< a variant; empty: this analysis is not wanted
};

/// Bjontegaard differences of each other variant against `reference`: `quality` over `rate`.
struct RateRule {
  std::string rate;
  std::string quality;
  std::string reference;  ///< a variant; empty: this analysis is not wanted
};

/// What each variant has more or less of than `reference`, all else equal.
struct DifferenceRule {
  std::vector<std::string> y;
  std::string reference;  ///< a variant; empty: this analysis is not wanted
};

/// Points that no other point beats in everything named; both empty: this analysis is not wanted.
struct ParetoRule {
  std::vector<std::string> most;   ///< more of it is better
  std::vector<std::string> least;  ///< less of it is better
};

/// The point with the most `best` among those within all limits.
struct Recommendation {
  std::string client;  ///< for whom
  std::string best;
  std::vector<std::pair<std::string, double>> at_most;
};

/// Smaller and shorter, for --quick.
struct QuickCut {
  std::vector<Assignment> settings;
  std::vector<Axis> sweep;            ///< replaces axes of the same key
  std::vector<Axis> around;           ///< replaces the whole list, if it has any
  std::vector<std::string> variants;  ///< the only ones kept; empty: all
};

/// An experiment file, read and checked (docs/LAB.md gives its keys): points are scenes x variants x sweep,
/// or with `around` the base and then one key at a time changed.
struct Experiment {
  std::string name;
  std::string title;
  std::string figure;  ///< its counterpart in a paper
  std::string notes;   ///< how it differs from that
  bool live = false;   ///< real programs and clocks instead of points in virtual time
  std::vector<Assignment> settings;
  std::vector<SceneChoice> scenes;
  std::vector<Variant> variants;
  std::vector<Axis> sweep;
  std::vector<Axis> around;
  QuickCut quick;
  std::vector<Plot> plots;
  CrossoverRule crossover;
  RateRule rate;
  DifferenceRule difference;
  ParetoRule pareto;
  std::vector<Recommendation> recommendations;
};

/// From TOML text (ASCII); `origin` names the file in errors, which are one line. Safe on any text.
Result<Experiment> parse_experiment(std::string_view toml, const std::string& origin);

/// Names of the experiments that travel inside the program, ascending.
std::vector<std::string> shipped_experiments();
/// The TOML text of one; empty: no such name.
std::string_view shipped_experiment_text(std::string_view name);

/// An experiment's text, and where the files it names are looked for first.
struct ExperimentSource {
  std::string text;
  std::string origin;
  std::string folder;  ///< empty: the current one
};

/// A shipped experiment by name, or a file when the name ends in ".toml".
Result<ExperimentSource> load_experiment_text(const std::string& name_or_file);

}  // namespace atlaswire::lab
