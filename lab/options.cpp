#include "lab/options.h"

#include "base/option_check.h"
#include "base/version.h"

#include <CLI/CLI.hpp>

namespace atlaswire::lab {
namespace {

constexpr const char* kFooter = R"(Examples:
  atlas-lab list                                   what experiments there are
  atlas-lab run latency --quick                    under a minute: out/lab/latency-quick/report.html
  atlas-lab run latency                            the whole of it; Ctrl-C and the same command again go on
  atlas-lab run latency --scene town.glb --path walk.csv --set latency_ms=0,50,100 --only "SAS 4 MPix" --only ATW
  atlas-lab show latency > mine.toml               an experiment to change; docs/LAB.md has the keys
  atlas-lab keys                                   every setting, its default and range
  atlas-lab plan latency --out big | parallel -j4  points as commands, for GNU parallel or Slurm ...
  atlas-lab report big                             ... and their tables, plots and page
  atlas-lab compare truth.png view.png             every metric of one picture against another

Exit codes: 0 done, 1 a point failed, 2 usage or bad experiment, 3 scene or path, 4 no Vulkan device, 9 cannot
write, 130 interrupted: finished points are kept, and the same command goes on from there.)";

/// The texts that become other types after parsing.
struct Raw {
  std::vector<std::string> scenes;
  std::vector<std::string> paths;
};

void add_request(CLI::App& command, RunOptions& run, Raw& raw) {
  command
      .add_option("experiment", run.experiment,
                  "A shipped experiment's name (atlas-lab list), or a .toml file")
      ->required();
  command.add_option("--scene", raw.scenes,
                     "Built-in scene or .glb file instead of the experiment's; repeatable");
  command.add_option(
      "--path", raw.paths,
      "Camera path (built-in name or .csv) of the --scene at the same place; without: the scene's own "
      "(FILE_path.csv beside FILE.glb)");
  command
      .add_option("--set", run.request.set,
                  "KEY=VALUE or KEY=A,B,C: fixes a setting or an axis anew (atlas-lab keys); repeatable")
      ->allow_extra_args(false);
  command.add_option("--only", run.request.only, "Keep this variant; repeatable")->allow_extra_args(false);
  command.add_flag("--quick", run.request.quick,
                   "Smaller and shorter: under a minute on two cores, same code");
  command.add_option("--out", run.out, "Results folder; out/lab/NAME if not told (NAME-quick with --quick)");
}

void add_run(CLI::App& app, LabOptions& options, Raw& raw) {
  CLI::App* command = app.add_subcommand("run", "Run an experiment, or go on with it, and make its report");
  RunOptions& run = options.run;
  add_request(*command, run, raw);
  command->add_option("--jobs", run.jobs, "Points at once, 0..1024; 0: one a core. Timings want 1");
  command->add_option("--point", run.point, "Run only the point with this id, without tables (see plan)");
  command->add_flag("--fresh", run.fresh, "Delete the points that are there first");
  command->add_flag("--force", run.force, "Use points of other commits too");
  command->add_flag("--json", run.json, "Print results.json on stdout at the end");
  command->add_flag("!--no-report", run.report, "Tables only, no plots and page");
  command->callback([&options] { options.command = LabOptions::Command::kRun; });
}

void add_reading(CLI::App& app, LabOptions& options, Raw& raw) {
  using Command = LabOptions::Command;
  CLI::App* list = app.add_subcommand("list", "List the shipped experiments");
  list->callback([&options] { options.command = Command::kList; });
  CLI::App* show = app.add_subcommand("show", "Print a shipped experiment's file");
  show->add_option("experiment", options.name, "Its name")->required();
  show->callback([&options] { options.command = Command::kShow; });
  CLI::App* keys = app.add_subcommand("keys", "List every setting with its default and range");
  keys->callback([&options] { options.command = Command::kKeys; });
  CLI::App* plan = app.add_subcommand("plan", "Print each point as a command of its own");
  add_request(*plan, options.run, raw);
  plan->callback([&options] { options.command = Command::kPlan; });
}

void add_after(CLI::App& app, LabOptions& options) {
  using Command = LabOptions::Command;
  CLI::App* merge = app.add_subcommand("merge", "Gather the points of several folders of one plan into one");
  merge->add_option("folders", options.folders, "Results folders")->required();
  merge->add_option("--out", options.out, "Results folder to fill")->required();
  merge->add_flag("--force", options.force, "Mix points of different commits");
  merge->callback([&options] { options.command = Command::kMerge; });
  CLI::App* report =
      app.add_subcommand("report", "Make tables, plots and report.html from the points in a folder");
  report->add_option("folder", options.folders, "Results folder")->required()->expected(1);
  report->callback([&options] { options.command = Command::kReport; });
  CLI::App* compare = app.add_subcommand("compare", "Every metric of a picture against a reference");
  compare->add_option("reference", options.reference, "PNG")->required();
  compare->add_option("picture", options.picture, "PNG of the same size")->required();
  compare->add_flag("--json", options.json, "As JSON");
  compare->callback([&options] { options.command = Command::kCompare; });
  CLI::App* point = app.add_subcommand("point", "Run one point from a file of settings; what run starts");
  point->add_option("--settings", options.point.settings, "JSON file as in points/ID/settings.json")
      ->required();
  point->add_option("--out", options.point.out, "Existing folder for result.json and pictures")->required();
  point->add_option("--truth", options.point.truth, "Folder for ground truth that points share");
  point->add_flag("--live", options.live, "With real programs and clocks");
  point->callback([&options] { options.command = Command::kPoint; });
}

/// Paths go with scenes by place. A path alone goes with the experiment's own scene.
void pair_scenes(const Raw& raw, RunOptions& run) {
  if (raw.paths.size() > std::max<std::size_t>(raw.scenes.size(), 1)) {
    throw ProgramError(ExitCode::kUsage, "--path: more paths than scenes");
  }
  for (std::size_t i = 0; i < raw.scenes.size(); ++i) {
    run.request.scenes.push_back({raw.scenes[i], i < raw.paths.size() ? raw.paths[i] : ""});
  }
  if (raw.scenes.empty() && !raw.paths.empty()) run.request.set.push_back("path=" + raw.paths[0]);
}

}  // namespace

LabOptions parse_lab_options(int argc, const char* const* argv) {
  LabOptions options;
  Raw raw;
  CLI::App app{"atlas-lab: measures streaming methods in virtual time, over whole experiments", "atlas-lab"};
  app.footer(kFooter);
  app.set_version_flag("--version", std::string("atlas-lab ") + kVersion);
  app.set_config("--config", "", "Read options from this TOML file ([run] jobs = 2); the command line wins");
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.option_defaults()->always_capture_default();
  app.require_subcommand(1);
  add_run(app, options, raw);
  add_reading(app, options, raw);
  add_after(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return {LabOptions::Command::kPrint, app.help()};
  } catch (const CLI::CallForVersion&) {
    return {LabOptions::Command::kPrint, app.version() + "\n"};
  } catch (const CLI::ParseError& e) {
    throw ProgramError(ExitCode::kUsage, std::string(e.what()) + "; see atlas-lab --help");
  }
  demand_range("--jobs", options.run.jobs, std::size_t{0}, std::size_t{1024});
  pair_scenes(raw, options.run);
  return options;
}

}  // namespace atlaswire::lab
