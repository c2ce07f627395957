#pragma once

#include "base/result.h"
#include "lab/plan.h"
#include "lab/point_result.h"
#include "lab/provenance.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace atlaswire::lab {

/// One finished point as it is kept: what was asked, by which program, and what came out.
struct PointRecord {
  std::string id;
  std::vector<std::pair<std::string, std::string>> settings;  ///< all_values()
  Facts provenance;                                           ///< program_facts(), the point's own, the date
  double wall_s = 0;
  PointResult result;

  /// The provenance's "commit"; empty: there is none.
  [[nodiscard]] std::string commit() const;
};

/// JSON text and back; numbers survive exactly, NaN is null. Errors: kBadRecord.
std::string to_json(const PointRecord& record);
Result<PointRecord> parse_record(std::string_view json);

/// Whoever opens `file` sees the old text or the whole new one. Makes no folders. Throws
/// ProgramError(kCannotWrite).
void write_whole(const std::filesystem::path& file, std::string_view text);
/// Nothing: no such file, or it cannot be read.
std::optional<std::string> read_whole(const std::filesystem::path& file);

/// A results folder:
///   plan.json        the experiment as text and its points
///   points/ID/       result.json (last, so that its presence means finished) and pictures
///   truth/           ground truth shared by points
///   results.csv, timings.csv, frames.csv, results.json, report.html
class Store {
 public:
  /// Nothing is made or read yet.
  explicit Store(std::filesystem::path root) : root_(std::move(root)) {}

  [[nodiscard]] const std::filesystem::path& root() const { return root_; }
  [[nodiscard]] std::filesystem::path point_folder(const std::string& id) const {
    return root_ / "points" / id;
  }
  [[nodiscard]] std::filesystem::path truth_folder() const { return root_ / "truth"; }

  /// Makes the folders. Throws ProgramError(kCannotWrite).
  void make_folders() const;
  /// The ids of finished points, ascending.
  [[nodiscard]] std::vector<std::string> finished() const;
  /// Errors: kNotFound, kBadRecord.
  [[nodiscard]] Result<PointRecord> load(const std::string& id) const;
  /// kOtherCommit with the cure, if any finished point was made by another commit than `commit`.
  [[nodiscard]] Result<void> check_commit(const std::string& commit) const;
  /// Removes all points, finished or not, and the truth.
  void clear() const;

 private:
  std::filesystem::path root_;
};

}  // namespace atlaswire::lab
