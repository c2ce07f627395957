#pragma once

#include "lab/plan.h"
#include "lab/store.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace atlaswire::lab {

/// How a sweep runs.
struct SweepSettings {
  /// The program that runs one point, and its first words; `--settings FILE --out FOLDER --truth FOLDER`
  /// follow.
  std::vector<std::string> command;
  std::size_t jobs = 1;                  ///< points at once, >= 1
  std::vector<std::string> environment;  ///< NAME=VALUE for it, unless set already
};

/// A point that gave no result.
struct Failure {
  std::string id;
  std::string label;
  int exit_code = 0;
  std::string line;  ///< the last it said on standard error
};

/// Where a sweep stands.
struct SweepProgress {
  std::size_t points = 0;            ///< to run, without those found finished
  std::size_t done = 0;              ///< of them, failed ones included
  double fraction = 0;               ///< of the work, parts of running points included, 0..1
  std::string finished;              ///< the label of the point that just ended; empty: none did
  double finished_s = 0;             ///< the time it took
  const Failure* failure = nullptr;  ///< how it failed, or nullptr
};

/// How a sweep ended.
struct SweepOutcome {
  std::size_t reused = 0;  ///< found finished
  std::size_t done = 0;    ///< finished now
  std::vector<Failure> failed;
  bool interrupted = false;
};

/// Runs the points that the store does not have, each once, in parallel processes; a point that fails does
/// not stop the others. `should_stop` is asked several times a second: then running points are ended and
/// forgotten, finished ones stay. `report` hears of every change.
SweepOutcome run_sweep(const Plan& plan, const Store& store, const SweepSettings& settings,
                       const std::function<void(const SweepProgress&)>& report,
                       const std::function<bool()>& should_stop);

}  // namespace atlaswire::lab
