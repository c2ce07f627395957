#include "server/frame_stats.h"

#include "base/program.h"

#include <fmt/format.h>

#include <algorithm>

namespace atlaswire::server {

StatsCsv::StatsCsv(const std::string& path) {
  if (path.empty()) return;
  file_.open(path, std::ios::trunc);
  if (!file_)
    throw ProgramError(ExitCode::kCannotWrite, fmt::format("--stats-csv {}: cannot write there", path));
  file_ << "time_s,session,frame,pose,idr,dropped,pose_age_ms,visibility_ms,allocation_ms,shading_ms,"
           "conversion_ms,render_ms,encoder_wait_ms,encode_ms,session_wait_ms,send_ms,cover_ms,video_bytes,"
           "meta_bytes,visible_patches,added_patches,removed_patches,shaded_texels,bias,allocated_texels,"
           "partial_tail_texels,on_stacks_texels,inaccessible_texels,free_texels,moved_patches,refused_"
           "patches,atlas_reset,waiting_patches,motion_ms,motion_bytes\n";
}

void StatsCsv::add(SessionId session, const Departure& d) {
  if (!file_.is_open()) return;
  const EncodedFrame& f = *d.frame;
  const FrameReport& r = f.report;
  const proto::StageStamps& s = f.stamps;
  file_ << fmt::format("{:.6f},{},{},{},{},{},", static_cast<double>(to_nanos(d.left)) * 1e-9, value(session),
                       value(f.frame), value(f.pose), f.idr ? 1 : 0, d.dropped ? 1 : 0);
  file_ << fmt::format("{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},", to_ms(s.render_start - s.pose_received),
                       to_ms(r.render.visibility), to_ms(r.render.allocation), to_ms(r.render.shading),
                       to_ms(r.render.conversion), to_ms(s.render_end - s.render_start));
  file_ << fmt::format("{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},", to_ms(s.encode_end - r.encode - s.render_end),
                       to_ms(r.encode), to_ms(d.queued - s.encode_end), to_ms(d.left - d.queued),
                       to_ms(f.cover));
  file_ << fmt::format("{},{},{},{},{},{},{:.3f},", f.video.size(), f.meta.size(), r.visible_patches,
                       r.added_patches, r.removed_patches, r.shaded_texels, r.bias);
  file_ << fmt::format("{},{},{},{},{},", r.usage.allocated, r.usage.partial_tail, r.usage.on_stacks,
                       r.usage.inaccessible, r.usage.free);
  file_ << fmt::format("{},{},{},{},", r.layout.moved, r.layout.refused, r.layout.reset ? 1 : 0,
                       r.waiting_patches);
  file_ << fmt::format("{:.3f},{}\n", to_ms(r.render.motion), f.motion.size());
}

void StatsLine::add(const Departure& d) {
  const EncodedFrame& f = *d.frame;
  ++sums_.frames;
  if (d.dropped) ++sums_.dropped;
  sums_.video_bytes += d.dropped ? 0 : f.video.size();
  sums_.meta_bytes += f.meta.size() + f.motion.size();
  sums_.visible += f.report.visible_patches;
  const FrameReport& report = f.report;
  sums_.usage.allocated += report.usage.allocated;
  sums_.usage.partial_tail += report.usage.partial_tail;
  sums_.usage.on_stacks += report.usage.on_stacks;
  sums_.usage.inaccessible += report.usage.inaccessible;
  sums_.usage.free += report.usage.free;
  sums_.moved += report.layout.moved;
  sums_.refused += report.layout.refused;
  sums_.resets += report.layout.reset ? 1 : 0;
  sums_.bias += report.bias;
  sums_.visibility += f.report.render.visibility;
  sums_.allocation += f.report.render.allocation;
  sums_.shading += f.report.render.shading;
  sums_.conversion += f.report.render.conversion;
  sums_.render += f.stamps.render_end - f.stamps.render_start;
  sums_.encode += f.report.encode;
  sums_.send += d.left - d.queued;
}

std::string StatsLine::take(Duration elapsed, std::size_t sessions) {
  const Sums s = std::exchange(sums_, {});
  const double seconds = std::max(to_seconds(elapsed), 1e-9);
  const double frames = s.frames == 0 ? 1.0 : static_cast<double>(s.frames);
  const auto mean = [&](Duration sum) { return to_ms(sum) / frames; };
  const auto mbps = [&](std::uint64_t bytes) { return static_cast<double>(bytes) * 8e-6 / seconds; };
  return fmt::format(
      "sessions {} | fps {:.1f} | video {:.2f} Mbps | meta {:.2f} Mbps | ms: visibility {:.1f}, allocation "
      "{:.1f}, "
      "shading {:.1f}, conversion {:.1f}, render {:.1f}, encode {:.1f}, send {:.1f} | patches {:.0f} | "
      "dropped {}",
      sessions, static_cast<double>(s.frames) / seconds, mbps(s.video_bytes), mbps(s.meta_bytes),
      mean(s.visibility), mean(s.allocation), mean(s.shading), mean(s.conversion), mean(s.render),
      mean(s.encode), mean(s.send), static_cast<double>(s.visible) / frames, s.dropped);
}

std::string StatsLine::atlas() const {
  const render::AtlasUsage& u = sums_.usage;
  const auto texels = static_cast<double>(
      std::max<std::uint64_t>(1, u.allocated + u.partial_tail + u.on_stacks + u.inaccessible + u.free));
  const auto percent = [&](std::uint64_t part) { return 100 * static_cast<double>(part) / texels; };
  const double frames = sums_.frames == 0 ? 1.0 : static_cast<double>(sums_.frames);
  return fmt::format(
      "atlas: allocated {:.1f} %, tails {:.1f} %, stacks {:.1f} %, inaccessible {:.1f} %, free {:.1f} % | "
      "bias "
      "{:.2f} octaves | a frame: {:.1f} blocks moved, {:.1f} patches refused | resets {}",
      percent(u.allocated), percent(u.partial_tail), percent(u.on_stacks), percent(u.inaccessible),
      percent(u.free), sums_.bias / frames, static_cast<double>(sums_.moved) / frames,
      static_cast<double>(sums_.refused) / frames, sums_.resets);
}

}  // namespace atlaswire::server
