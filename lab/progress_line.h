#pragma once

#include "base/time.h"
#include "lab/sweep.h"

#include <cstdio>
#include <string>

namespace atlaswire::lab {

/// "[######....]  6/10 points, 4 min left": one line without its end. `elapsed` since the start.
std::string progress_bar(const SweepProgress& progress, Duration elapsed);

/// "SAS 4 MPix, latency_ms 100: done in 12 s" or "...: failed (exit code 4): no Vulkan device".
std::string finished_line(const SweepProgress& progress);

/// "45 s", "12 min", "3.5 h".
std::string rough_time(Duration duration);

/// A sweep's progress on a stream: a bar that is drawn over on a terminal, a line for each finished point
/// elsewhere.
class ProgressLine {
 public:
  ProgressLine(std::FILE* stream, bool terminal, Time start)
      : stream_(stream), terminal_(terminal), start_(start) {}

  void show(const SweepProgress& progress, Time now);
  /// Leaves the bar's line.
  void finish();

 private:
  std::FILE* stream_;
  bool terminal_;
  Time start_;
  bool bar_stands_ = false;
};

}  // namespace atlaswire::lab
