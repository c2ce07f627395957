#include "lab/results.h"

#include "base/program.h"
#include "lab/analysis.h"
#include "lab/lab_error.h"
#include "lab/point_process.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace atlaswire::lab {
namespace {

using Json = nlohmann::ordered_json;

/// NaN and infinities become null.
Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

const char* kind_name(Plot::Kind kind) {
  switch (kind) {
    case Plot::Kind::kLine:
      return "line";
    case Plot::Kind::kBars:
      return "bars";
    case Plot::Kind::kStack:
      return "stack";
    case Plot::Kind::kScatter:
      return "scatter";
  }
  return "line";
}

Json plots_json(const Experiment& e) {
  Json plots = Json::array();
  for (const Plot& p : e.plots) {
    plots.push_back({{"kind", kind_name(p.kind)},
                     {"title", p.title},
                     {"x", p.x},
                     {"y", p.y},
                     {"series", p.series},
                     {"x_label", p.x_label.empty() ? p.x : p.x_label},
                     {"y_label", p.y_label},
                     {"log_x", p.log_x}});
  }
  return plots;
}

Json figures_json(const std::vector<Figure>& figures) {
  Json j = Json::object();
  for (const Figure& f : figures) j[f.name] = number(f.value);
  return j;
}

/// The PNGs that a point left, relative to the results folder, ascending.
Json pictures_json(const Store& store, const std::string& id) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(store.point_folder(id), ignored)) {
    if (entry.path().extension() == ".png")
      names.push_back("points/" + id + "/" + entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Json row_json(const Row& row, const Plan& plan, const Store& store) {
  Json settings = Json::object();
  for (const auto& [key, text] : row.record.settings) settings[key] = text;
  return {{"id", row.point.id},
          {"label", label(row.point, plan)},
          {"variant", row.point.variant},
          {"varied", row.point.varied},
          {"settings", std::move(settings)},
          {"figures", figures_json(row.record.result.figures)},
          {"timings", figures_json(row.record.result.timings)},
          {"wall_s", row.record.wall_s},
          {"pictures", pictures_json(store, row.point.id)}};
}

/// Facts that all points share, and for the others each value that occurs.
Json provenance_json(const std::vector<Row>& rows) {
  Json all = Json::object();
  for (const Row& row : rows) {
    for (const auto& [name, text] : row.record.provenance) {
      Json& values = all[name];
      if (std::find(values.begin(), values.end(), text) == values.end()) values.push_back(text);
    }
  }
  return all;
}

Json analysis_json(const Analysis& a) {
  Json crossovers = Json::array();
  for (const Crossover& c : a.crossovers) {
    Json at = Json::array();
    for (const Crossover::At& one : c.at) at.push_back({{"x", number(one.x)}, {"rises", one.rises}});
    crossovers.push_back({{"group", c.group},
                          {"variant", c.variant},
                          {"reference_first", c.reference_first},
                          {"at", std::move(at)}});
  }
  Json rates = Json::array();
  for (const RateDifference& d : a.rates) {
    rates.push_back({{"group", d.group},
                     {"variant", d.variant},
                     {"rate_percent", number(d.rate_percent)},
                     {"quality", number(d.quality)},
                     {"why", d.why}});
  }
  Json differences = Json::array();
  for (const Difference& d : a.differences) {
    differences.push_back({{"group", d.group},
                           {"variant", d.variant},
                           {"y", d.y},
                           {"value", number(d.value)},
                           {"more", number(d.more)}});
  }
  Json advice = Json::array();
  for (const Advice& one : a.advice)
    advice.push_back({{"client", one.client}, {"id", one.id}, {"label", one.label}});
  return {{"crossovers", std::move(crossovers)},
          {"rates", std::move(rates)},
          {"differences", std::move(differences)},
          {"front", a.front},
          {"advice", std::move(advice)}};
}

Json rules_json(const Experiment& e) {
  Json recommendations = Json::array();
  for (const Recommendation& r : e.recommendations) {
    Json limits = Json::object();
    for (const auto& [name, most] : r.at_most) limits[name] = most;
    recommendations.push_back({{"client", r.client}, {"best", r.best}, {"at_most", std::move(limits)}});
  }
  return {{"crossover", {{"x", e.crossover.x}, {"y", e.crossover.y}, {"reference", e.crossover.reference}}},
          {"rate", {{"rate", e.rate.rate}, {"quality", e.rate.quality}, {"reference", e.rate.reference}}},
          {"difference", {{"y", e.difference.y}, {"reference", e.difference.reference}}},
          {"pareto", {{"most", e.pareto.most}, {"least", e.pareto.least}}},
          {"recommend", std::move(recommendations)}};
}

Json rows_json(const StoredPlan& stored, const std::vector<Row>& rows, const Store& store) {
  Json list = Json::array();
  for (const Row& row : rows) list.push_back(row_json(row, stored.plan, store));
  return list;
}

}  // namespace

std::string to_json(const StoredPlan& stored) {
  Json points = Json::array();
  for (const PlannedPoint& point : stored.plan.points) points.push_back(Json::parse(settings_json(point)));
  return Json{{"origin", stored.source.origin},
              {"quick", stored.quick},
              {"experiment", stored.source.text},
              {"points", std::move(points)}}
             .dump(1) +
         "\n";
}

Result<StoredPlan> parse_stored_plan(std::string_view json) {
  try {
    const Json j = Json::parse(json);
    StoredPlan stored;
    stored.source.origin = j.at("origin").get<std::string>();
    stored.source.text = j.at("experiment").get<std::string>();
    stored.quick = j.at("quick").get<bool>();
    auto experiment = parse_experiment(stored.source.text, stored.source.origin);
    if (experiment.has_error()) return experiment.error();
    stored.experiment = *std::move(experiment);
    std::vector<PlannedPoint> points;
    for (const Json& one : j.at("points")) {
      auto point = parse_settings_json(one.dump());
      if (point.has_error()) return point.error();
      points.push_back(*std::move(point));
    }
    stored.plan = plan_of(std::move(points));
    return stored;
  } catch (const Json::exception& e) {
    return Error{LabError::kBadRecord, e.what()};
  }
}

StoredPlan load_plan(const Store& store) {
  const auto file = store.root() / "plan.json";
  const auto text = read_whole(file);
  if (!text) {
    throw ProgramError(ExitCode::kUsage, store.root().string() +
                                             " holds no plan.json: it is no results folder of atlas-lab run");
  }
  auto stored = parse_stored_plan(*text);
  if (stored.has_error())
    throw ProgramError(ExitCode::kUsage, file.string() + ": " + stored.error().message());
  return *std::move(stored);
}

std::string results_json(const StoredPlan& stored, const std::vector<Row>& rows, const Store& store) {
  const Experiment& e = stored.experiment;
  return Json{{"name", e.name},
              {"title", e.title},
              {"figure", e.figure},
              {"notes", e.notes},
              {"live", e.live},
              {"quick", stored.quick},
              {"planned", stored.plan.points.size()},
              {"provenance", provenance_json(rows)},
              {"varying", stored.plan.varying},
              {"plots", plots_json(e)},
              {"rules", rules_json(e)},
              {"points", rows_json(stored, rows, store)},
              {"analysis", analysis_json(analyse(e, stored.plan, rows))}}
             .dump(1) +
         "\n";
}

std::vector<Row> write_results(const StoredPlan& stored, const Store& store) {
  std::vector<Row> rows = load_rows(stored.plan, store);
  write_whole(store.root() / "results.csv", results_csv(stored.plan, rows));
  write_whole(store.root() / "timings.csv", timings_csv(stored.plan, rows));
  write_whole(store.root() / "frames.csv", frames_csv(stored.plan, rows));
  write_whole(store.root() / "results.json", results_json(stored, rows, store));
  return rows;
}

}  // namespace atlaswire::lab
