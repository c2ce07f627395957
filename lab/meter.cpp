#include "lab/meter.h"

#include "base/program.h"
#include "client/quality.h"
#include "render/image/compose.h"
#include "render/image/flip.h"
#include "render/image/metrics.h"
#include "render/image/png.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace atlaswire::lab {

Meter::Meter(bool flip, std::filesystem::path pictures) : flip_(flip), pictures_(std::move(pictures)) {}

void Meter::add(double t_s, double pose_age_ms, const Displayed& before, const Displayed& now) {
  const client::Quality quality = client::compare(now.truth.picture, now.view);
  const FrameRow row{.t_s = t_s,
                     .mssim = quality.mssim,
                     .psnr = quality.psnr,
                     .dssim = render::dssim(quality.mssim),
                     .flip = flip_ ? render::flip(now.truth.picture, now.view) : kNotApplicable,
                     .flicker = render::flicker({.reference = &before.truth.picture, .picture = &before.view},
                                                {.reference = &now.truth.picture, .picture = &now.view}),
                     .holes = 1 - quality.coverage,
                     .pose_age_ms = pose_age_ms};
  const bool is_worst = rows_.empty() || row.mssim < worst_.row.mssim;
  rows_.push_back(row);
  forward_fragments_ += now.truth.forward_fragments;
  deferred_fragments_ += now.truth.deferred_fragments;
  if (pictures_.empty()) return;
  if (is_worst) worst_ = {row, now};
  last_ = {row, now};
}

void Meter::add_figures(double client_hz, std::vector<Figure>& figures) const {
  const auto mean = [&](double FrameRow::*member) {
    double sum = 0;
    for (const FrameRow& row : rows_) sum += row.*member;
    return rows_.empty() ? kNotApplicable : sum / static_cast<double>(rows_.size());
  };
  double lowest = kNotApplicable;
  for (const FrameRow& row : rows_) lowest = std::fmin(lowest, row.mssim);
  figures.push_back({"mssim", mean(&FrameRow::mssim)});
  figures.push_back({"mssim_lowest", lowest});
  figures.push_back({"psnr", mean(&FrameRow::psnr)});
  figures.push_back({"dssim", mean(&FrameRow::dssim)});
  figures.push_back({"flip", mean(&FrameRow::flip)});
  figures.push_back({"flicker", mean(&FrameRow::flicker)});
  figures.push_back({"holes", mean(&FrameRow::holes)});
  figures.push_back({"pose_age_ms", mean(&FrameRow::pose_age_ms)});
  const auto per_second = [&](std::uint64_t fragments) {
    return 1e-6 * client_hz * static_cast<double>(fragments) / static_cast<double>(rows_.size());
  };
  figures.push_back({"forward_mpix_per_s", per_second(forward_fragments_)});
  figures.push_back({"deferred_mpix_per_s", per_second(deferred_fragments_)});
  figures.push_back({"measured_frames", static_cast<double>(rows_.size())});
}

void Meter::write_pictures() const {
  if (pictures_.empty() || rows_.empty()) return;
  write("worst.png", worst_);
  write("last.png", last_);
}

void Meter::write(const char* name, const Kept& kept) const {
  const render::Picture difference = render::heat_difference(kept.shown.truth.picture, kept.shown.view);
  const std::array panels{render::Panel{.image = &kept.shown.truth.picture,
                                        .label = fmt::format("ground truth at {:.2f} s", kept.row.t_s)},
                          render::Panel{.image = &kept.shown.view,
                                        .label = fmt::format("client view, MSSIM {:.3f}", kept.row.mssim)},
                          render::Panel{.image = &difference, .label = "difference x4"}};
  if (const Result<void> written = render::write_png(render::side_by_side(panels), pictures_ / name);
      !written) {
    throw ProgramError(ExitCode::kCannotWrite, written.error().message());
  }
}

}  // namespace atlaswire::lab
