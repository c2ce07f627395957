#include "lab/compare.h"

#include "base/program.h"
#include "render/image/flip.h"
#include "render/image/metrics.h"
#include "render/image/png.h"

#include <fmt/format.h>

namespace atlaswire::lab {
namespace {

render::Picture read(const std::filesystem::path& file) {
  auto picture = render::read_png(file);
  if (picture.has_error()) throw ProgramError(ExitCode::kUsage, picture.error().message());
  return *std::move(picture);
}

}  // namespace

std::vector<Figure> compare_pictures(const std::filesystem::path& reference,
                                     const std::filesystem::path& picture) {
  const render::Picture truth = read(reference);
  const render::Picture view = read(picture);
  if (truth.extent != view.extent) {
    throw ProgramError(ExitCode::kUsage,
                       fmt::format("{} has {}x{} pixels and {} {}x{}: they must have one size",
                                   reference.string(), truth.extent.width, truth.extent.height,
                                   picture.string(), view.extent.width, view.extent.height));
  }
  const double mssim = render::mssim(truth, view);
  return {{"mssim", mssim},
          {"psnr", render::psnr(truth, view)},
          {"dssim", render::dssim(mssim)},
          {"flip", render::flip(truth, view)},
          {"holes", render::hole_share(view)}};
}

}  // namespace atlaswire::lab
