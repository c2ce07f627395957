#pragma once

#include "lab/plan.h"
#include "lab/point_process.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace atlaswire::lab {

/// What `atlas-lab run` and `atlas-lab plan` are told.
struct RunOptions {
  std::string experiment;  ///< shipped name or .toml file
  PlanRequest request;
  std::filesystem::path out;  ///< empty: out/lab/NAME
  std::size_t jobs = 0;       ///< 0: one a core
  std::string point;          ///< id of the only point to run; empty: all
  bool fresh = false;         ///< deletes what is there
  bool force = false;         ///< mixes commits
  bool json = false;          ///< results.json on stdout
  bool report = true;
};

/// The outcome of parsing: what to do, and with what.
struct LabOptions {
  enum class Command { kPrint, kRun, kList, kShow, kKeys, kPlan, kMerge, kReport, kPoint, kCompare };
  Command command = Command::kPrint;
  std::string text;                            ///< kPrint: help or version
  RunOptions run;                              ///< kRun, kPlan
  std::string name;                            ///< kShow
  std::vector<std::filesystem::path> folders;  ///< kMerge: sources; kReport: the one folder
  std::filesystem::path out;                   ///< kMerge
  bool force = false;                          ///< kMerge: mixes commits
  PointJob point;                              ///< kPoint
  bool live = false;                           ///< kPoint: with real programs
  std::filesystem::path reference;             ///< kCompare
  std::filesystem::path picture;               ///< kCompare
  bool json = false;                           ///< kCompare
};

/// Reads the command line and the file that --config names (the command line wins). Throws ProgramError
/// (kUsage) with one line.
LabOptions parse_lab_options(int argc, const char* const* argv);

}  // namespace atlaswire::lab
