#include "lab/progress_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace atlaswire::lab {

std::string rough_time(Duration duration) {
  const double s = std::max(0.0, to_seconds(duration));
  if (s < 90) return fmt::format("{:.0f} s", s);
  if (s < 90 * 60) return fmt::format("{:.0f} min", s / 60);
  return fmt::format("{:.1f} h", s / 3600);
}

std::string progress_bar(const SweepProgress& progress, Duration elapsed) {
  constexpr int kCells = 30;
  const int full = static_cast<int>(std::floor(progress.fraction * kCells));
  std::string text =
      fmt::format("[{}{}] {}/{} points", std::string(static_cast<std::size_t>(full), '#'),
                  std::string(static_cast<std::size_t>(kCells - full), '.'), progress.done, progress.points);
  // The first hundredth is start-up, and says nothing about the rest.
  if (progress.fraction > 0.01 && progress.fraction < 1) {
    text += ", " + rough_time(from_seconds(to_seconds(elapsed) * (1 / progress.fraction - 1))) + " left";
  }
  return text;
}

std::string finished_line(const SweepProgress& progress) {
  if (progress.failure) {
    return fmt::format("{}: failed (exit code {}): {}", progress.finished, progress.failure->exit_code,
                       progress.failure->line);
  }
  return fmt::format("{}: done in {}", progress.finished, rough_time(from_seconds(progress.finished_s)));
}

void ProgressLine::show(const SweepProgress& progress, Time now) {
  const bool ended = !progress.finished.empty();
  if (!ended && !terminal_) return;
  if (bar_stands_) std::fputs("\r\x1b[K", stream_);
  bar_stands_ = false;
  const std::string bar = progress_bar(progress, now - start_);
  if (ended && !terminal_) fmt::print(stream_, "{}  {}\n", bar, finished_line(progress));
  if (ended && terminal_ && progress.failure) fmt::print(stream_, "{}\n", finished_line(progress));
  if (terminal_) {
    std::fputs(bar.c_str(), stream_);
    bar_stands_ = true;
  }
  std::fflush(stream_);
}

void ProgressLine::finish() {
  if (bar_stands_) std::fputs("\n", stream_);
  bar_stands_ = false;
}

}  // namespace atlaswire::lab
