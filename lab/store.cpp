#include "lab/store.h"

#include "base/program.h"
#include "lab/lab_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>

namespace atlaswire::lab {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// FrameRow's members, in the order of columns.
constexpr double FrameRow::*kFrameMembers[] = {&FrameRow::t_s,   &FrameRow::mssim,      &FrameRow::psnr,
                                               &FrameRow::dssim, &FrameRow::flip,       &FrameRow::flicker,
                                               &FrameRow::holes, &FrameRow::pose_age_ms};

/// JSON has neither infinity nor NaN.
Json number(double v) {
  if (std::isinf(v)) return v > 0 ? "inf" : "-inf";
  return std::isnan(v) ? Json(nullptr) : Json(v);
}

double number(const Json& j) {
  if (j.is_null()) return kNotApplicable;
  if (j.is_number()) return j.get<double>();
  const double infinity = std::numeric_limits<double>::infinity();
  if (j == "inf") return infinity;
  if (j == "-inf") return -infinity;
  throw std::domain_error("not a number");
}

Json figures_json(const std::vector<Figure>& figures) {
  Json j = Json::object();
  for (const Figure& f : figures) j[f.name] = number(f.value);
  return j;
}

std::vector<Figure> figures_from(const Json& j) {
  std::vector<Figure> figures;
  for (const auto& [name, value] : j.items()) figures.push_back({name, number(value)});
  return figures;
}

Json texts_json(const std::vector<std::pair<std::string, std::string>>& texts) {
  Json j = Json::object();
  for (const auto& [name, text] : texts) j[name] = text;
  return j;
}

std::vector<std::pair<std::string, std::string>> texts_from(const Json& j) {
  std::vector<std::pair<std::string, std::string>> texts;
  for (const auto& [name, text] : j.items()) texts.emplace_back(name, text.get<std::string>());
  return texts;
}

Json frames_json(const std::vector<FrameRow>& frames) {
  Json rows = Json::array();
  for (const FrameRow& frame : frames) {
    Json row = Json::array();
    for (const auto member : kFrameMembers) row.push_back(number(frame.*member));
    rows.push_back(std::move(row));
  }
  return rows;
}

FrameRow frame_from(const Json& row) {
  FrameRow frame;
  for (std::size_t i = 0; i < std::size(kFrameMembers); ++i) frame.*kFrameMembers[i] = number(row.at(i));
  return frame;
}

}  // namespace

std::string PointRecord::commit() const {
  for (const auto& [name, text] : provenance) {
    if (name == "commit") return text;
  }
  return {};
}

std::string to_json(const PointRecord& record) {
  Json j;
  j["id"] = record.id;
  j["provenance"] = texts_json(record.provenance);
  j["wall_s"] = number(record.wall_s);
  j["settings"] = texts_json(record.settings);
  j["figures"] = figures_json(record.result.figures);
  j["timings"] = figures_json(record.result.timings);
  j["frames"] = frames_json(record.result.frames);
  return j.dump(1) + "\n";
}

Result<PointRecord> parse_record(std::string_view json) {
  try {
    const Json j = Json::parse(json);
    PointRecord record;
    record.id = j.at("id").get<std::string>();
    record.provenance = texts_from(j.at("provenance"));
    record.wall_s = number(j.at("wall_s"));
    record.settings = texts_from(j.at("settings"));
    record.result.figures = figures_from(j.at("figures"));
    record.result.timings = figures_from(j.at("timings"));
    for (const Json& row : j.at("frames")) record.result.frames.push_back(frame_from(row));
    return record;
  } catch (const std::exception& e) {
    return Error{LabError::kBadRecord, e.what()};
  }
}

void write_whole(const fs::path& file, std::string_view text) {
  const fs::path part = file.string() + ".part";
  errno = 0;
  std::ofstream out(part, std::ios::binary | std::ios::trunc);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  std::error_code error;
  if (out) fs::rename(part, file, error);
  if (out && !error) return;
  throw ProgramError(ExitCode::kCannotWrite,
                     fmt::format("cannot write {}: {}; choose another folder with --out", file.string(),
                                 error ? error.message() : std::strerror(errno)));
}

std::optional<std::string> read_whole(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(in), {}};
}

void Store::make_folders() const {
  for (const fs::path& folder : {root_ / "points", truth_folder()}) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (!error) continue;
    throw ProgramError(ExitCode::kCannotWrite,
                       fmt::format("cannot make the folder {}: {}; choose another one with --out",
                                   folder.string(), error.message()));
  }
}

std::vector<std::string> Store::finished() const {
  std::vector<std::string> ids;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(root_ / "points", ignored)) {
    if (fs::exists(entry.path() / "result.json", ignored)) ids.push_back(entry.path().filename().string());
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

Result<PointRecord> Store::load(const std::string& id) const {
  const fs::path file = point_folder(id) / "result.json";
  const auto text = read_whole(file);
  if (!text) return Error{LabError::kNotFound, file.string()};
  auto record = parse_record(*text);
  if (record.has_error()) return Error{record.error().code, file.string() + ": " + record.error().detail};
  if (record->id != id) return Error{LabError::kBadRecord, file.string() + " holds point " + record->id};
  return record;
}

Result<void> Store::check_commit(const std::string& commit) const {
  for (const std::string& id : finished()) {
    const auto record = load(id);
    if (record.has_error()) return record.error();
    if (record->commit() == commit) continue;
    return Error{
        LabError::kOtherCommit,
        fmt::format("{} holds points of commit {}, and this is {}: choose another --out, delete them with "
                    "--fresh, or mix all the same with --force",
                    root_.string(), record->commit(), commit)};
  }
  return {};
}

void Store::clear() const {
  std::error_code error;
  fs::remove_all(root_ / "points", error);
  if (!error) fs::remove_all(truth_folder(), error);
  if (error)
    throw ProgramError(ExitCode::kCannotWrite, "cannot empty " + root_.string() + ": " + error.message());
}

}  // namespace atlaswire::lab
