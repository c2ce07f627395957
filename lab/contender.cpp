#include "lab/contender.h"

#include "base/program.h"
#include "lab/sas_contender.h"
#include "lab/warp_contender.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace atlaswire::lab {

std::unique_ptr<Contender> make_contender(const PointSettings& settings, render::Device& device,
                                          std::shared_ptr<const render::Scene> scene) {
  using render::WarpKind;
  if (settings.method == "sas") return make_sas_contender(settings, device, std::move(scene));
  const auto warp = [&](WarpKind kind) {
    return make_warp_contender(kind, settings, device, std::move(scene));
  };
  if (settings.method == "atw") return warp(WarpKind::kTimeWarp);
  if (settings.method == "mesh") return warp(WarpKind::kMesh);
  if (settings.method == "iterative") return warp(WarpKind::kIterative);
  throw ProgramError(ExitCode::kUsage,
                     fmt::format("method '{}' is none of sas, atw, mesh, iterative", settings.method));
}

render::Camera display_camera(const PointSettings& settings) {
  render::Camera camera;
  camera.extent = settings.display;
  const double half_width = std::tan(settings.horizontal_fov * std::numbers::pi / 360);
  camera.vertical_fov = 2 * std::atan(half_width * settings.display.height / settings.display.width);
  return camera;
}

render::LensCorrection display_lens(const PointSettings& settings) {
  const Result<render::LensCorrection> lens = render::parse_lens(settings.lens);
  if (!lens) throw ProgramError(ExitCode::kUsage, lens.error().message());
  return *lens;
}

}  // namespace atlaswire::lab
