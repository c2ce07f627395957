#include "client/run_facts.h"

namespace atlaswire::client {
namespace {

double per_second(std::uint64_t from, std::uint64_t to, double seconds) {
  return seconds > 0 ? static_cast<double>(to - from) / seconds : 0;
}

void fill_rates(const RunFacts& facts, RunReport& r) {
  const NetworkSnapshot& a = facts.measured_from;
  const NetworkSnapshot& b = facts.measured_to;
  const double span = to_seconds(b.taken - a.taken);
  const auto mbps = [&](std::uint64_t from, std::uint64_t to) { return per_second(from, to, span) * 8e-6; };
  r.server_fps = per_second(a.updates, b.updates, span);
  r.video_mbps = mbps(a.traffic.video, b.traffic.video);
  r.meta_mbps = mbps(a.traffic.meta, b.traffic.meta);
  r.poses_mbps = mbps(a.traffic.poses, b.traffic.poses);
  r.control_mbps =
      mbps(a.traffic.control_in + a.traffic.control_out, b.traffic.control_in + b.traffic.control_out);
  r.measured_s = to_seconds(facts.display.end - facts.display.measured_from);
  r.client_fps = per_second(0, facts.display.displayed_measured, r.measured_s);
  r.pair_fps = per_second(0, facts.display.paired_measured, r.measured_s);
}

}  // namespace

void fill_report(const RunFacts& facts, RunReport& r) {
  if (facts.display.end > facts.display.measured_from && facts.display.first) fill_rates(facts, r);
  const NetworkSnapshot& last = facts.measured_to;
  r.frames_announced = last.updates;
  r.frames_decoded = facts.decoded.decoded;
  r.frames_paired = facts.decoded.pairing.paired;
  r.restarts = facts.decoded.restarts;
  r.frames_never_shown = facts.decoded.never_shown;
  r.frames_lost = last.frames.lost;
  r.frames_withheld = last.frames.withheld + facts.decoded.skipped;
  r.frames_failed = facts.decoded.failed;
  r.frames_overrun = last.overrun_frames;
  r.frames_displayed = facts.display.displayed;
  r.traffic = last.traffic;
  r.packets = last.packets;
  r.patches = facts.decoded.patches;
  r.triangles = facts.decoded.triangles;
  r.stages = facts.display.log.stages(facts.display.measured_from);
  r.round_trip = facts.display.log.round_trip(facts.display.measured_from);
  r.pose_to_display = facts.display.log.pose_to_display(facts.display.measured_from);
  r.motion_to_photon = facts.display.motion_to_photon.summary();
  r.clock_synchronized = last.clock_synchronized;
  r.clock_error_ms = to_ms(last.clock_error);
  r.network_round_trip_ms = to_ms(last.round_trip);
}

}  // namespace atlaswire::client
