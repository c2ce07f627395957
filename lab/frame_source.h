#pragma once

#include "base/time.h"
#include "lab/contender.h"
#include "lab/head_motion.h"
#include "lab/point.h"
#include "lab/point_result.h"
#include "lab/rate_budget.h"
#include "lab/work.h"
#include "server/encoded_frame.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace atlaswire::lab {

/// When a frame's pose was taken and when its picture will be looked at, as far as the server can know; times
/// since the path's start.
struct FrameTiming {
  Duration posed{};
  Duration made{};  ///< when the server looks at the scene, which moves by the path's time
  Duration shown_from{};
  Duration shown_until{};
};

/// The server's end of a point: asks the contender for frames, holds all channels to the point's rate, and
/// counts what they take of bytes, texels and wall-clock time.
class FrameSource {
 public:
  /// Both are borrowed.
  FrameSource(const PointSettings& settings, Contender& contender, const HeadMotion& motion);

  /// A frame for `head`, the newest pose that has arrived. `refresh`: the client cannot decode P-frames.
  /// Throws ProgramError when the encoder fails.
  server::EncodedFrame make(PoseId id, const Pose& head, const FrameTiming& timing, bool refresh);

  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  /// What all of them took to make.
  [[nodiscard]] const Work& work() const { return making_; }
  /// Bytes, texels and memory over `streamed`: `video_mbps`, `meta_mbps`, ...
  void add_figures(Duration streamed, std::vector<Figure>& figures) const;
  /// Means over frames in milliseconds: `server_frame_ms` with its parts, and `server_cpu_ms`.
  void add_timings(std::vector<Figure>& timings) const;

 private:
  [[nodiscard]] server::ViewRequest request_for(const Pose& head, const FrameTiming& timing) const;
  void count(const server::EncodedFrame& frame);

  PointSettings settings_;
  Contender* contender_;
  const HeadMotion* motion_;
  bool is_warp_;
  double eyes_;  ///< pictures that the method needs for the display's eyes; we make one of them
  std::optional<RateBudget> budget_;
  render::Camera camera_;

  std::uint64_t frames_ = 0;
  std::uint64_t video_bytes_ = 0;
  std::uint64_t meta_bytes_ = 0;
  std::uint64_t motion_bytes_ = 0;        ///< of it
  std::uint64_t largest_meta_bytes_ = 0;  ///< of one frame
  std::uint64_t first_meta_bytes_ = 0;
  server::FrameReport first_;             ///< the first frame's
  std::uint64_t frames_until_whole_ = 0;  ///< before the first one that left no patch for later
  std::uint64_t shaded_texels_ = 0;
  std::uint64_t visible_patches_ = 0;
  double bias_ = 0;
  double used_share_ = 0;
  std::uint64_t held_ = 0;     ///< blocks of patches that were visible in the frame before, over all frames
  std::uint64_t moved_ = 0;    ///< of these, given another place or size
  std::uint64_t refused_ = 0;  ///< visible patches without a block
  std::uint64_t resets_ = 0;
  render::RenderTimings render_;
  Work making_;
  Duration encoding_{};  ///< of it
};

}  // namespace atlaswire::lab
