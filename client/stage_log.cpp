#include "client/stage_log.h"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <string>

namespace atlaswire::client {
namespace {

void append_row(std::string& out, const StageRow& row, Time zero) {
  auto end = std::back_inserter(out);
  fmt::format_to(end, "{:.3f},{},{},{}", to_ms(row.draw.start - zero), value(row.pair.frame),
                 value(row.pair.pose), row.is_first() ? 1 : 0);
  for (const Duration d : stage_durations(row.pair, row.draw)) fmt::format_to(end, ",{:.3f}", to_ms(d));
  fmt::format_to(end, ",{:.3f},{:.3f},", to_ms(row.pair.video_decoding), to_ms(row.pair.meta_decoding));
  if (const auto latency = pose_to_display(row.pair, row.draw))
    fmt::format_to(end, "{:.3f}", to_ms(*latency));
  out += '\n';
}

}  // namespace

std::array<Summary, kStageCount> StageLog::stages(Time from) const {
  std::array<Distribution, kStageCount> all;
  for (const StageRow& row : rows_) {
    if (row.draw.start < from) continue;
    const StageDurations durations = stage_durations(row.pair, row.draw);
    for (std::size_t s = 0; s < kStageCount; ++s) {
      const auto stage = static_cast<Stage>(s);
      const bool of_every_frame = stage == Stage::kClientRendering || stage == Stage::kDisplayAge;
      const bool needs_pose = stage == Stage::kClientToServer || stage == Stage::kServerIdle;
      if (!of_every_frame && !row.is_first()) continue;
      if (needs_pose && !row.pair.pose_sampled) continue;
      all[s].add(durations[s]);
    }
  }
  std::array<Summary, kStageCount> summaries;
  for (std::size_t s = 0; s < kStageCount; ++s) summaries[s] = all[s].summary();
  return summaries;
}

Summary StageLog::pose_to_display(Time from) const {
  Distribution all;
  for (const StageRow& row : rows_) {
    if (row.draw.start < from) continue;
    if (const auto latency = client::pose_to_display(row.pair, row.draw)) all.add(*latency);
  }
  return all.summary();
}

Summary StageLog::round_trip(Time from) const {
  Distribution all;
  for (const StageRow& row : rows_) {
    if (row.draw.start < from || !row.is_first()) continue;
    if (const auto latency = client::pose_to_display(row.pair, row.draw)) all.add(*latency);
  }
  return all.summary();
}

Result<void> StageLog::write_csv(const std::filesystem::path& file, Time zero) const {
  std::string text = "display_start_ms,frame,pose,first";
  for (std::size_t s = 0; s < kStageCount; ++s) text += fmt::format(",{}_ms", name(static_cast<Stage>(s)));
  text += ",video_decoding_ms,meta_decoding_ms,pose_to_display_ms\n";
  for (const StageRow& row : rows_) append_row(text, row, zero);
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) return Error(std::error_code(errno, std::generic_category()), file.string());
  return {};
}

}  // namespace atlaswire::client
