#include "lab/program.h"

#include "lab/compare.h"
#include "lab/keys.h"
#include "lab/live_run.h"
#include "lab/options.h"
#include "lab/run_command.h"
#include "lab/tables.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace atlaswire::lab {
namespace {

void print_list() {
  for (const std::string& name : shipped_experiments()) {
    const auto experiment = parse_experiment(shipped_experiment_text(name), name).value();
    fmt::print("{:<14} {} ({})\n", name, experiment.title, experiment.figure);
  }
}

void print_keys() {
  const PointSettings defaults;
  fmt::print("{:<20} {:<14} {:<30} {}\n", "key", "default", "allowed", "meaning");
  for (const Key& key : keys()) {
    fmt::print("{:<20} {:<14} {:<30} {}\n", key.name, value_text(key, defaults), allowed_text(key), key.help);
  }
}

void show(const std::string& name) {
  const std::string_view text = shipped_experiment_text(name);
  if (text.empty())
    throw ProgramError(ExitCode::kUsage, "show " + name + ": must be a name that atlas-lab list gives");
  fmt::print("{}", text);
}

void compare(const LabOptions& options) {
  const std::vector<Figure> figures = compare_pictures(options.reference, options.picture);
  nlohmann::ordered_json j;
  for (const Figure& f : figures) {
    if (options.json) {
      j[f.name] = std::isfinite(f.value) ? nlohmann::ordered_json(f.value) : nlohmann::ordered_json(nullptr);
    } else {
      fmt::print("{:<6} {}\n", f.name, cell(f.value));
    }
  }
  if (options.json) fmt::print("{}\n", j.dump(2));
}

}  // namespace

int run_lab(int argc, char** argv, const PointRunner& measure) {
  using Command = LabOptions::Command;
  const LabOptions options = parse_lab_options(argc, argv);
  switch (options.command) {
    case Command::kPrint:
      fmt::print("{}", options.text);
      break;
    case Command::kRun:
      return static_cast<int>(run_experiment(options.run));
    case Command::kList:
      print_list();
      break;
    case Command::kShow:
      show(options.name);
      break;
    case Command::kKeys:
      print_keys();
      break;
    case Command::kPlan:
      print_plan(options.run);
      break;
    case Command::kMerge:
      merge_folders(options.folders, options.out, options.force);
      break;
    case Command::kReport:
      report_folder(options.folders.front());
      break;
    case Command::kPoint:
      return static_cast<int>(run_point_job(options.point, options.live ? PointRunner(run_live) : measure));
    case Command::kCompare:
      compare(options);
      break;
  }
  return 0;
}

}  // namespace atlaswire::lab
