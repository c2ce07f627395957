#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace atlaswire::lab {

/// What a figure holds that does not apply to a point, such as the atlas's megatexels of a time warp.
inline constexpr double kNotApplicable = std::numeric_limits<double>::quiet_NaN();

/// One measured number under the name of its CSV column. The name says the unit where there is one
/// ("video_mbps", "pose_age_ms").
struct Figure {
  std::string name;
  double value = kNotApplicable;
};

/// One displayed frame that was compared with the truth. What was not measured is NaN.
struct FrameRow {
  double t_s = 0;  ///< display time on the path
  double mssim = kNotApplicable;
  double psnr = kNotApplicable;  ///< dB
  double dssim = kNotApplicable;
  double flip = kNotApplicable;
  double flicker = kNotApplicable;
  double holes = kNotApplicable;        ///< of the display's pixels, 0..1
  double pose_age_ms = kNotApplicable;  ///< from the pose a frame was made for to its display
};

/// What one point gives. `figures` and `frames` are equal for equal settings on one machine and commit;
/// `timings` are wall clock and are kept apart from them in every file.
struct PointResult {
  std::vector<Figure> figures;   ///< same names in the same order for every method; NaN: not applicable
  std::vector<Figure> timings;   ///< milliseconds of wall clock
  std::vector<FrameRow> frames;  ///< in order of time
  /// Provenance that only the point knows, such as {"device", "llvmpipe (LLVM 15.0.6), Mesa 22.3.6"}.
  std::vector<std::pair<std::string, std::string>> facts;
};

/// Where a point writes and whom it tells. All members may be left as they are.
struct PointOutputs {
  std::filesystem::path pictures;        ///< existing folder for its PNGs; empty: none
  std::filesystem::path truth_cache;     ///< folder shared by the points of a sweep; empty: no cache
  std::function<void(double)> progress;  ///< called with 0..1
  std::function<bool()> should_stop;     ///< true: throw Interrupted at the next frame
};

/// Thrown by run_point once `should_stop` has said so.
struct Interrupted {};

}  // namespace atlaswire::lab
