#include "lab/run_command.h"

#include "client/interrupt.h"
#include "lab/child_process.h"
#include "lab/lab_error.h"
#include "lab/progress_line.h"
#include "lab/provenance.h"
#include "lab/report_page.h"
#include "lab/results.h"
#include "lab/sweep.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <thread>

namespace atlaswire::lab {
namespace {

namespace fs = std::filesystem;

/// One line for people; kNotFound of scenes and paths and the like are all bad usage.
template <class T>
T value_or_usage(Result<T> result) {
  if (result.has_error()) throw ProgramError(ExitCode::kUsage, result.error().message());
  return std::move(*result);
}

/// What is wrong with settings' values is usage; a scene, path or profile that is not there is kBadScene.
Plan plan_or_throw(const Experiment& experiment, const PlanRequest& request) {
  auto plan = make_plan(experiment, request);
  if (plan.has_value()) return *std::move(plan);
  const auto code = plan.error().code;
  const bool missing_file = code == LabError::kNotFound && !plan.error().detail.starts_with("--only");
  throw ProgramError(missing_file ? ExitCode::kBadScene : ExitCode::kUsage, plan.error().message());
}

StoredPlan make_stored_plan(const RunOptions& options) {
  StoredPlan stored;
  stored.source = value_or_usage(load_experiment_text(options.experiment));
  stored.quick = options.request.quick;
  stored.experiment = value_or_usage(parse_experiment(stored.source.text, stored.source.origin));
  PlanRequest request = options.request;
  request.folder = stored.source.folder;
  stored.plan = plan_or_throw(stored.experiment, request);
  return stored;
}

fs::path folder_of(const RunOptions& options, const Experiment& experiment) {
  if (!options.out.empty()) return options.out;
  return fs::path("out") / "lab" / (experiment.name + (options.request.quick ? "-quick" : ""));
}

/// How many points at once, and with how many threads each renders on a CPU.
SweepSettings sweep_settings(const RunOptions& options, const Experiment& experiment) {
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  SweepSettings settings;
  settings.command = {own_program(), "point"};
  if (experiment.live) settings.command.emplace_back("--live");
  settings.jobs = options.jobs == 0 ? cores : options.jobs;
  if (experiment.live) settings.jobs = 1;  // they would disturb each other's clocks
  const std::size_t threads = std::max<std::size_t>(1, cores / settings.jobs);
  if (settings.jobs > 1) settings.environment.push_back(fmt::format("LP_NUM_THREADS={}", threads));
  return settings;
}

void keep_only_point(const std::string& id, Plan& plan) {
  if (id.empty()) return;
  std::erase_if(plan.points, [&](const PlannedPoint& p) { return p.id != id; });
  if (plan.points.empty())
    throw ProgramError(ExitCode::kUsage,
                       "--point " + id + ": no point of this experiment has that id (atlas-lab plan)");
}

void tell_failures(const std::vector<Failure>& failures) {
  for (const Failure& f : failures) {
    fmt::print(stderr, "failed: {} (point {}, exit code {}): {}\n", f.label, f.id, f.exit_code, f.line);
  }
}

/// Tables always; the page where it can be made.
void finish_folder(const StoredPlan& stored, const Store& store, bool report, std::FILE* stream) {
  const std::size_t rows = write_results(stored, store).size();
  fmt::print(stream, "{} of {} points: {}\n", rows, stored.plan.points.size(),
             (store.root() / "results.csv").string());
  if (!report) return;
  if (const auto made = make_report(store.root()); made.has_error()) {
    fmt::print(stderr, "atlas-lab: warning: no report: {}\n", made.error().message());
  } else {
    fmt::print(stream, "report: {}\n", (store.root() / "report.html").string());
  }
}

/// As a POSIX shell takes it for one word.
std::string shell_word(const std::string& text) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("-_./=:,+@%", c);
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// The words that make the same plan again.
std::string request_words(const RunOptions& options, const fs::path& out) {
  std::vector<std::string> words{"run", options.experiment};
  const PlanRequest& r = options.request;
  if (r.quick) words.emplace_back("--quick");
  for (const std::string& text : r.set) words.insert(words.end(), {"--set", text});
  for (const std::string& name : r.only) words.insert(words.end(), {"--only", name});
  for (const SceneChoice& choice : r.scenes) {
    words.insert(words.end(), {"--scene", choice.scene, "--path", choice.path.empty() ? "" : choice.path});
  }
  words.insert(words.end(), {"--out", out.string()});
  std::string line = shell_word(own_program());
  for (const std::string& word : words) line += " " + shell_word(word);
  return line;
}

}  // namespace

ExitCode run_experiment(const RunOptions& options) {
  StoredPlan stored = make_stored_plan(options);
  const Store store(folder_of(options, stored.experiment));
  if (options.fresh) store.clear();
  if (!options.force) {
    if (auto ok = store.check_commit(build_commit()); ok.has_error())
      throw ProgramError(ExitCode::kUsage, ok.error().message());
  }
  store.make_folders();
  write_whole(store.root() / "plan.json", to_json(stored));
  Plan todo = stored.plan;
  keep_only_point(options.point, todo);
  client::watch_interrupts();
  ProgressLine line(stderr, isatty(STDERR_FILENO) != 0, steady_now());
  const SweepOutcome outcome = run_sweep(
      todo, store, sweep_settings(options, stored.experiment),
      [&](const SweepProgress& p) { line.show(p, steady_now()); }, client::interrupted);
  line.finish();
  tell_failures(outcome.failed);
  if (options.point.empty()) {
    finish_folder(stored, store, options.report && !outcome.interrupted, options.json ? stderr : stdout);
    if (options.json) fmt::print("{}", read_whole(store.root() / "results.json").value_or(""));
  }
  if (outcome.interrupted) {
    fmt::print(stderr, "interrupted: {} finished points are kept; the same command goes on from there\n",
               outcome.reused + outcome.done);
    return ExitCode::kInterrupted;
  }
  return outcome.failed.empty() ? ExitCode::kOk : ExitCode::kInternal;
}

void print_plan(const RunOptions& options) {
  const StoredPlan stored = make_stored_plan(options);
  const std::string line = request_words(options, folder_of(options, stored.experiment));
  std::vector<std::string> seen;
  for (const PlannedPoint& point : stored.plan.points) {
    if (std::find(seen.begin(), seen.end(), point.id) != seen.end()) continue;
    seen.push_back(point.id);
    fmt::print("{} --point {}\n", line, point.id);
  }
}

void merge_folders(const std::vector<fs::path>& sources, const fs::path& out, bool force) {
  const Store target(out);
  target.make_folders();
  const std::string plan = to_json(load_plan(Store(sources.front())));
  write_whole(out / "plan.json", plan);
  std::string commit;
  for (const fs::path& source : sources) {
    const Store from(source);
    if (to_json(load_plan(from)) != plan) {
      throw ProgramError(ExitCode::kUsage, fmt::format("{} and {} hold points of different plans",
                                                       sources.front().string(), source.string()));
    }
    for (const std::string& id : from.finished()) {
      const PointRecord record = value_or_usage(from.load(id));
      if (commit.empty()) commit = record.commit();
      if (!force && record.commit() != commit) {
        throw ProgramError(
            ExitCode::kUsage,
            fmt::format("{} holds points of commit {}, others are of {}: mix all the same with --force",
                        source.string(), record.commit(), commit));
      }
      std::error_code error;
      fs::copy(from.point_folder(id), target.point_folder(id),
               fs::copy_options::recursive | fs::copy_options::overwrite_existing, error);
      if (error)
        throw ProgramError(ExitCode::kCannotWrite, "cannot copy point " + id + ": " + error.message());
    }
  }
  finish_folder(load_plan(target), target, true, stdout);
}

void report_folder(const fs::path& folder) {
  const Store store(folder);
  finish_folder(load_plan(store), store, true, stdout);
}

}  // namespace atlaswire::lab
