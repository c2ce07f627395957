#include "lab/point_process.h"

#include "base/time.h"
#include "client/interrupt.h"
#include "lab/keys.h"
#include "lab/lab_error.h"
#include "lab/provenance.h"
#include "lab/store.h"

#include <sys/prctl.h>

#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace atlaswire::lab {
namespace {

using Json = nlohmann::ordered_json;

/// Says where the point stands whenever another hundredth is done.
class ProgressSpeaker {
 public:
  void operator()(double fraction) {
    if (fraction < next_) return;
    next_ = fraction + 0.01;
    std::printf("progress %.3f\n", fraction);
    std::fflush(stdout);
  }

 private:
  double next_ = 0;
};

/// A figure under the name of a setting would make columns and plots ambiguous.
void check_names(const PointResult& result) {
  for (const auto* figures : {&result.figures, &result.timings}) {
    for (const Figure& f : *figures) {
      if (find_key(f.name))
        throw ProgramError(ExitCode::kInternal, "a figure has the name of a setting: " + f.name);
    }
  }
}

}  // namespace

std::string settings_json(const PlannedPoint& point) {
  Json settings = Json::object();
  for (const auto& [key, text] : all_values(point.settings)) settings[key] = text;
  return Json{{"id", point.id}, {"variant", point.variant}, {"varied", point.varied}, {"settings", settings}}
             .dump(1) +
         "\n";
}

Result<PlannedPoint> parse_settings_json(std::string_view json) {
  try {
    const Json j = Json::parse(json);
    PlannedPoint point{j.at("id").get<std::string>(),
                       j.at("variant").get<std::string>(),
                       j.at("varied").get<std::string>(),
                       {}};
    for (const auto& [key, text] : j.at("settings").items()) {
      if (auto set = set_value(key, text.get<std::string>(), point.settings); set.has_error())
        return set.error();
    }
    return point;
  } catch (const Json::exception& e) {
    return Error{LabError::kBadRecord, e.what()};
  }
}

ExitCode run_point_job(const PointJob& job, const PointRunner& runner) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  client::watch_interrupts();
  const auto text = read_whole(job.settings);
  if (!text) throw ProgramError(ExitCode::kUsage, "cannot read " + job.settings.string());
  const auto point = parse_settings_json(*text);
  if (point.has_error())
    throw ProgramError(ExitCode::kUsage, job.settings.string() + ": " + point.error().message());
  const Time start = steady_now();
  PointRecord record{point->id, all_values(point->settings), program_facts()};
  try {
    record.result = runner(point->settings, {job.out, job.truth, ProgressSpeaker{}, client::interrupted});
  } catch (const Interrupted&) {
    return ExitCode::kInterrupted;
  }
  check_names(record.result);
  record.wall_s = to_seconds(steady_now() - start);
  record.provenance.emplace_back("date", utc_now());
  for (const auto& fact : record.result.facts) record.provenance.push_back(fact);
  write_whole(job.out / "result.json", to_json(record));
  return ExitCode::kOk;
}

}  // namespace atlaswire::lab
