#include "lab/frame_source.h"

#include "base/program.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace atlaswire::lab {
namespace {

/// What is left of a frame's life is cut into so many steps where the future may be known.
constexpr int kForeseenSteps = 3;

double mean(double sum, std::uint64_t count) {
  return count == 0 ? kNotApplicable : sum / static_cast<double>(count);
}

}  // namespace

FrameSource::FrameSource(const PointSettings& settings, Contender& contender, const HeadMotion& motion)
    : settings_(settings),
      contender_(&contender),
      motion_(&motion),
      is_warp_(settings.method != "sas"),
      eyes_(is_warp_ && settings.stereo ? 2 : 1),
      camera_(display_camera(settings)) {
  if (settings.bitrate_mbps > 0 && settings.qp < 0) {
    const double rate = settings.bitrate_mbps * 1e6 / eyes_;
    budget_.emplace(BitRate{static_cast<std::uint64_t>(std::llround(rate))}, settings.server_hz);
  }
}

server::ViewRequest FrameSource::request_for(const Pose& head, const FrameTiming& timing) const {
  server::ViewRequest request;
  request.camera = camera_;
  request.camera.pose = head;
  request.cover = timing.shown_until - timing.posed;
  const Duration middle = (timing.shown_from + timing.shown_until) / 2;
  request.scene_time = timing.made;
  if (settings_.foresee_motion) {
    // The middle of the moments at which the client displays, not of the time between two frames.
    const Duration displayed = middle - from_seconds(0.5 / settings_.client_hz);
    request.scene_ahead = std::max(std::max(displayed, timing.shown_from) - timing.made, Duration::zero());
  }
  if (is_warp_) {
    if (settings_.predict) request.camera.pose = extrapolate(head, middle - timing.posed);
    if (settings_.stereo) request.camera.pose = render::eye_pose(request.camera.pose, -settings_.ipd / 2);
    return request;
  }
  if (settings_.stereo) request.hints.eye_separation = settings_.ipd;
  if (settings_.shade_at_display) request.hints.shading_eye = motion_->at(middle).position;
  for (int i = 0; settings_.foresight && i <= kForeseenSteps; ++i) {
    request.hints.foreseen.push_back(
        motion_->at(timing.shown_from + (timing.shown_until - timing.shown_from) * i / kForeseenSteps));
  }
  return request;
}

server::EncodedFrame FrameSource::make(PoseId id, const Pose& head, const FrameTiming& timing, bool refresh) {
  server::ViewRequest request = request_for(head, timing);
  request.pose = id;
  request.refresh = refresh;
  if (budget_) request.bit_rate = budget_->video_rate();
  const Work start = work_now();
  server::PreparedFrame prepared = contender_->maker().render(request);
  const Time rendered = steady_now();
  Result<server::EncodedFrame> frame = contender_->maker().encode(std::move(prepared));
  if (!frame) throw ProgramError(ExitCode::kInternal, "encoding failed: " + frame.error().message());
  encoding_ += steady_now() - rendered;
  making_ += work_now() - start;
  count(*frame);
  return std::move(*frame);
}

void FrameSource::count(const server::EncodedFrame& frame) {
  if (frames_ == 0) {
    first_meta_bytes_ = frame.meta.size();
    first_ = frame.report;
  }
  if (frames_until_whole_ == frames_ && frame.report.waiting_patches != 0) ++frames_until_whole_;
  ++frames_;
  const std::uint64_t meta = frame.meta.size() + frame.motion.size();
  largest_meta_bytes_ = std::max(largest_meta_bytes_, meta);
  video_bytes_ += frame.video.size();
  meta_bytes_ += meta;
  motion_bytes_ += frame.motion.size();
  if (budget_) budget_->on_frame(meta);
  const server::FrameReport& report = frame.report;
  shaded_texels_ += report.shaded_texels;
  visible_patches_ += report.visible_patches;
  bias_ += report.bias;
  held_ += report.visible_patches - report.layout.refused - report.added_patches;
  moved_ += report.layout.moved;
  refused_ += report.layout.refused;
  resets_ += report.layout.reset ? 1 : 0;
  used_share_ += static_cast<double>(report.usage.allocated) / static_cast<double>(settings_.atlas.area());
  render_.motion += report.render.motion;
  render_.visibility += report.render.visibility;
  render_.allocation += report.render.allocation;
  render_.shading += report.render.shading;
  render_.conversion += report.render.conversion;
}

void FrameSource::add_figures(Duration streamed, std::vector<Figure>& figures) const {
  const double seconds = to_seconds(streamed);
  const auto mbps = [&](std::uint64_t bytes) { return eyes_ * 8e-6 * static_cast<double>(bytes) / seconds; };
  const bool is_bare = settings_.bitrate_mbps <= 0 && settings_.qp < 0;
  const double video = is_bare ? kNotApplicable : mbps(video_bytes_);
  const auto of_atlas = [&](double value) { return is_warp_ ? kNotApplicable : value; };
  figures.push_back({"video_mbps", video});
  figures.push_back({"meta_mbps", mbps(meta_bytes_)});
  const bool moves = contender_->description().motion.has_value();
  figures.push_back({"motion_mbps", moves ? mbps(motion_bytes_) : kNotApplicable});
  figures.push_back({"total_mbps", video + mbps(meta_bytes_)});
  figures.push_back({"first_meta_kb", 1e-3 * static_cast<double>(first_meta_bytes_)});
  figures.push_back({"largest_meta_kb", 1e-3 * static_cast<double>(largest_meta_bytes_)});
  figures.push_back({"frames_until_whole", of_atlas(static_cast<double>(frames_until_whole_))});
  const auto first_bits = [&](std::uint32_t count) {
    return count == 0 ? kNotApplicable : 8.0 * static_cast<double>(first_meta_bytes_) / count;
  };
  figures.push_back({"grid_error_mm", of_atlas(1e3 * contender_->description().grid.max_error())});
  figures.push_back({"first_bits_per_vertex", first_bits(first_.new_vertices)});
  figures.push_back({"first_bits_per_triangle", first_bits(first_.added_triangles)});
  figures.push_back({"first_bits_per_patch", first_bits(first_.added_patches)});
  figures.push_back({"shaded_mpix_per_s", 1e-6 * eyes_ * static_cast<double>(shaded_texels_) / seconds});
  figures.push_back({"visible_patches", of_atlas(mean(static_cast<double>(visible_patches_), frames_))});
  figures.push_back({"atlas_used", of_atlas(mean(used_share_, frames_))});
  figures.push_back({"bias", of_atlas(mean(bias_, frames_))});
  figures.push_back({"refused_patches", of_atlas(static_cast<double>(refused_))});
  const double moved = mean(static_cast<double>(moved_), held_);
  figures.push_back({"unmoved_percent", of_atlas(100 * (1 - moved))});
  figures.push_back({"atlas_resets", of_atlas(static_cast<double>(resets_))});
  figures.push_back({"server_frames", static_cast<double>(frames_)});
}

void FrameSource::add_timings(std::vector<Figure>& timings) const {
  const auto add = [&](const char* name, Duration sum) {
    timings.push_back({name, mean(to_ms(sum), frames_)});
  };
  add("server_frame_ms", making_.wall);
  add("server_cpu_ms", making_.cpu);
  add("motion_ms", render_.motion);
  add("visibility_ms", render_.visibility);
  add("allocation_ms", render_.allocation);
  add("shading_ms", render_.shading);
  add("conversion_ms", render_.conversion);
  add("encoding_ms", encoding_);
}

}  // namespace atlaswire::lab
