#pragma once

#include "base/result.h"
#include "client/distribution.h"
#include "client/stage_times.h"

#include <array>
#include <filesystem>
#include <vector>

namespace atlaswire::client {

/// One displayed frame.
struct StageRow {
  PairTimes pair;
  DrawTimes draw;
  [[nodiscard]] bool is_first() const { return draw.start == draw.first_start; }
};

/// Every displayed frame's stage times, and what they add up to. One thread.
class StageLog {
 public:
  void add(const StageRow& row) { rows_.push_back(row); }
  [[nodiscard]] const std::vector<StageRow>& rows() const { return rows_; }

  /// Per stage, in milliseconds: stages 1 to 6 over the pairs that were displayed (1 and 2 of those that
  /// had a pose), 7 and 8 over all displayed frames. Rows that started before `from` are left out.
  [[nodiscard]] std::array<Summary, kStageCount> stages(Time from) const;
  /// Pose to display, in milliseconds, of every displayed frame, and of each pair's first one (the round
  /// trip of [SAS] 5.7).
  [[nodiscard]] Summary pose_to_display(Time from) const;
  [[nodiscard]] Summary round_trip(Time from) const;

  /// One line a displayed frame under a header line; times in milliseconds from `zero`.
  Result<void> write_csv(const std::filesystem::path& file, Time zero) const;

 private:
  std::vector<StageRow> rows_;
};

}  // namespace atlaswire::client
