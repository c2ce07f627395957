#include "client/report.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

namespace atlaswire::client {
namespace {

using Json = nlohmann::ordered_json;

Json percentiles(const Summary& s) {
  return {{"mean", s.mean}, {"p50", s.p50}, {"p95", s.p95}, {"p99", s.p99}, {"count", s.count}};
}

Json settings_json(const RunReport& r) {
  const ClientSettings& s = r.settings;
  return {{"connect", to_string(s.server)},
          {"path", r.path},
          {"size", fmt::format("{}x{}", s.size.width, s.size.height)},
          {"vertical_fov_radians", s.vertical_fov},
          {"stereo", s.stereo},
          {"ipd_m", s.stereo ? s.ipd : 0},
          {"lens", render::to_string(s.lens)},
          {"rate", s.rate},
          {"pose_rate", s.pose_rate},
          {"duration_s", to_seconds(s.duration)},
          {"warm_up_s", to_seconds(s.warm_up)},
          {"reference", s.reference},
          {"at_server_pose", s.at_server_pose}};
}

Json frames_json(const RunReport& r) {
  return {{"announced", r.frames_announced},     {"decoded", r.frames_decoded}, {"paired", r.frames_paired},
          {"never_shown", r.frames_never_shown}, {"restarts", r.restarts},      {"lost", r.frames_lost},
          {"withheld", r.frames_withheld},       {"failed", r.frames_failed},   {"overrun", r.frames_overrun},
          {"displayed", r.frames_displayed}};
}

Json bytes_json(const Traffic& t) {
  return {{"video", t.video},
          {"meta", t.meta},
          {"control_in", t.control_in},
          {"poses", t.poses},
          {"control_out", t.control_out},
          {"ignored", t.ignored}};
}

void add_quality(Json& j, const RunReport& r) {
  if (!r.quality) return;
  j["mssim"] = r.quality->mssim;
  j["mssim_lowest"] = r.quality->mssim_lowest;
  j["psnr"] = r.quality->psnr;
  j["coverage"] = r.quality->coverage;
  Json samples = Json::array();
  for (const Quality& q : r.samples) {
    samples.push_back({{"display_index", q.display_index},
                       {"frame", value(q.frame)},
                       {"mssim", q.mssim},
                       {"psnr", q.psnr},
                       {"coverage", q.coverage}});
  }
  j["samples"] = std::move(samples);
}

void row(std::string& out, const char* label, const std::string& text) {
  fmt::format_to(std::back_inserter(out), "  {:<22} {}\n", label, text);
}

void stage_rows(std::string& out, const RunReport& r) {
  fmt::format_to(std::back_inserter(out), "  {:<22} {:>9} {:>9} {:>9}\n", "stage, ms", "mean", "p50", "p95");
  const auto line = [&](const char* label, const Summary& s) {
    fmt::format_to(std::back_inserter(out), "  {:<22} {:>9.2f} {:>9.2f} {:>9.2f}\n", label, s.mean, s.p50,
                   s.p95);
  };
  for (std::size_t s = 0; s < kStageCount; ++s) line(name(static_cast<Stage>(s)), r.stages[s]);
  line("round trip (1-7)", r.round_trip);
  line("pose to display", r.pose_to_display);
  line("motion to photon", r.motion_to_photon);
}

}  // namespace

std::string to_json(const RunReport& r) {
  Json j;
  j["scene"] = r.scene;
  j["device"] = r.device;
  j["atlas"] = fmt::format("{}x{}", r.atlas.width, r.atlas.height);
  j["measured_s"] = r.measured_s;
  j["server"] = {{"fps", r.server_fps}};
  j["client"] = {{"fps", r.client_fps}, {"pair_fps", r.pair_fps}};
  j["video"] = {{"mbps", r.video_mbps}};
  j["meta"] = {{"mbps", r.meta_mbps}};
  j["poses"] = {{"mbps", r.poses_mbps}};
  j["control"] = {{"mbps", r.control_mbps}};
  add_quality(j, r);
  j["frames"] = frames_json(r);
  j["packets"] = {{"received", r.packets.received},
                  {"lost", r.packets.lost},
                  {"refused", r.packets.refused},
                  {"refresh_requests", r.packets.refresh_requests}};
  j["bytes"] = bytes_json(r.traffic);
  j["replica"] = {{"patches", r.patches}, {"triangles", r.triangles}};
  Json means;
  Json spreads;
  for (std::size_t s = 0; s < kStageCount; ++s) {
    means[name(static_cast<Stage>(s))] = r.stages[s].mean;
    spreads[name(static_cast<Stage>(s))] = percentiles(r.stages[s]);
  }
  j["stages_ms"] = std::move(means);
  j["stages_percentiles_ms"] = std::move(spreads);
  j["latency_ms"] = {{"round_trip", percentiles(r.round_trip)},
                     {"pose_to_display", percentiles(r.pose_to_display)},
                     {"motion_to_photon", percentiles(r.motion_to_photon)}};
  j["clock"] = {{"synchronized", r.clock_synchronized},
                {"error_bound_ms", r.clock_error_ms},
                {"round_trip_ms", r.network_round_trip_ms}};
  j["settings"] = settings_json(r);
  j["files"] = r.files;
  j["pictures_left_out"] = r.pictures_left_out;
  j["end"] = r.end.empty() ? "finished" : r.end;
  return j.dump(2) + "\n";
}

std::string to_table(const RunReport& r) {
  std::string out =
      fmt::format("{}: {} s measured, atlas {}x{}, {} patches, on {}\n", r.scene,
                  fmt::format("{:.1f}", r.measured_s), r.atlas.width, r.atlas.height, r.patches, r.device);
  row(out, "frames a second", fmt::format("server {:.1f}, displayed {:.1f}", r.server_fps, r.client_fps));
  row(out, "Mbps",
      fmt::format("video {:.2f}, meta {:.2f}, poses {:.3f}, control {:.3f}", r.video_mbps, r.meta_mbps,
                  r.poses_mbps, r.control_mbps));
  row(out, "frames",
      fmt::format("{} paired of {} announced, {} lost, {} withheld, {} failed", r.frames_paired,
                  r.frames_announced, r.frames_lost, r.frames_withheld, r.frames_failed));
  row(out, "packets",
      fmt::format("{} received, {} lost, {} refresh requests", r.packets.received, r.packets.lost,
                  r.packets.refresh_requests));
  stage_rows(out, r);
  if (r.quality) {
    row(out, "MSSIM",
        fmt::format("{:.4f} (lowest {:.4f}, {} samples)", r.quality->mssim, r.quality->mssim_lowest,
                    r.quality->count));
    row(out, "PSNR", fmt::format("{:.2f} dB", r.quality->psnr));
    row(out, "coverage", fmt::format("{:.3f} %", r.quality->coverage * 100));
  }
  for (const std::string& file : r.files) row(out, "wrote", file);
  if (!r.end.empty()) row(out, "ended early", r.end);
  return out;
}

}  // namespace atlaswire::client
