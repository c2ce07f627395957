#include "lab/tables.h"

#include "lab/keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

namespace atlaswire::lab {
namespace {

/// RFC 4180: quoted where it must be.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

std::string line(const std::vector<std::string>& cells) {
  std::string text;
  for (std::size_t i = 0; i < cells.size(); ++i) text += (i == 0 ? "" : ",") + quoted(cells[i]);
  return text + "\n";
}

std::vector<std::string> leading_names(const Plan& plan) {
  std::vector<std::string> names{"id", "variant", "varied"};
  names.insert(names.end(), plan.varying.begin(), plan.varying.end());
  return names;
}

std::vector<std::string> leading_cells(const Plan& plan, const PlannedPoint& point) {
  std::vector<std::string> cells{point.id, point.variant, point.varied};
  for (const std::string& key : plan.varying) cells.push_back(value_text(*find_key(key), point.settings));
  return cells;
}

/// Names in order of first appearance: methods may differ in what they have.
std::vector<std::string> names_of(const std::vector<Row>& rows, std::vector<Figure> PointResult::*member) {
  std::vector<std::string> names;
  for (const Row& row : rows) {
    for (const Figure& f : row.record.result.*member) {
      if (std::find(names.begin(), names.end(), f.name) == names.end()) names.push_back(f.name);
    }
  }
  return names;
}

double find(const std::vector<Figure>& figures, const std::string& name) {
  const auto found =
      std::find_if(figures.begin(), figures.end(), [&](const Figure& f) { return f.name == name; });
  return found == figures.end() ? kNotApplicable : found->value;
}

bool has(const std::vector<Figure>& figures, const std::string& name) {
  return std::any_of(figures.begin(), figures.end(), [&](const Figure& f) { return f.name == name; });
}

std::string table(const Plan& plan, const std::vector<Row>& rows, std::vector<Figure> PointResult::*member,
                  bool with_wall) {
  const std::vector<std::string> names = names_of(rows, member);
  std::vector<std::string> head = leading_names(plan);
  head.insert(head.end(), names.begin(), names.end());
  if (with_wall) head.emplace_back("wall_s");
  std::string text = line(head);
  for (const Row& row : rows) {
    std::vector<std::string> cells = leading_cells(plan, row.point);
    for (const std::string& name : names) cells.push_back(cell(find(row.record.result.*member, name)));
    if (with_wall) cells.push_back(cell(row.record.wall_s));
    text += line(cells);
  }
  return text;
}

}  // namespace

std::vector<Row> load_rows(const Plan& plan, const Store& store) {
  const std::vector<std::string> finished = store.finished();
  std::vector<Row> rows;
  for (const PlannedPoint& point : plan.points) {
    if (std::binary_search(finished.begin(), finished.end(), point.id)) {
      rows.push_back({point, store.load(point.id).value()});
    }
  }
  return rows;
}

std::string cell(double value) {
  if (std::isnan(value)) return {};
  constexpr double kExact = 9.007199254740992e15;
  if (value == std::floor(value) && std::abs(value) < kExact) return fmt::format("{:.0f}", value + 0.0);
  return fmt::format("{:.7g}", value);
}

std::string results_csv(const Plan& plan, const std::vector<Row>& rows) {
  return table(plan, rows, &PointResult::figures, false);
}

std::string timings_csv(const Plan& plan, const std::vector<Row>& rows) {
  return table(plan, rows, &PointResult::timings, true);
}

std::string frames_csv(const Plan& plan, const std::vector<Row>& rows) {
  std::vector<std::string> head = leading_names(plan);
  for (const char* name : {"t_s", "mssim", "psnr", "dssim", "flip", "flicker", "holes", "pose_age_ms"}) {
    head.emplace_back(name);
  }
  std::string text = line(head);
  for (const Row& row : rows) {
    const std::vector<std::string> leading = leading_cells(plan, row.point);
    for (const FrameRow& f : row.record.result.frames) {
      std::vector<std::string> cells = leading;
      for (const double v : {f.t_s, f.mssim, f.psnr, f.dssim, f.flip, f.flicker, f.holes, f.pose_age_ms}) {
        cells.push_back(cell(v));
      }
      text += line(cells);
    }
  }
  return text;
}

double number_of(const Row& row, const std::string& name) {
  if (has(row.record.result.figures, name)) return find(row.record.result.figures, name);
  if (has(row.record.result.timings, name)) return find(row.record.result.timings, name);
  const Key* key = find_key(name);
  if (!key) return kNotApplicable;
  const std::string text = value_text(*key, row.point.settings);
  double v = kNotApplicable;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), v);
  return parsed.ptr == text.data() + text.size() ? v : kNotApplicable;
}

std::string text_of(const Row& row, const std::string& name) {
  if (name == "variant") return row.point.variant;
  if (name == "varied") return row.point.varied;
  const Key* key = find_key(name);
  return key ? value_text(*key, row.point.settings) : cell(number_of(row, name));
}

}  // namespace atlaswire::lab
