#include "client/quality.h"

#include "render/image/metrics.h"

#include <algorithm>
#include <numeric>

namespace atlaswire::client {
namespace {

constexpr double kHighestPsnr = 99;

double coverage(const render::Picture& truth, const render::Picture& view) {
  std::uint64_t geometry = 0;
  std::uint64_t drawn = 0;
  for (std::size_t i = 3; i < truth.rgba.size(); i += 4) {
    if (truth.rgba[i] == 0) continue;
    ++geometry;
    drawn += view.rgba[i] != 0 ? 1U : 0U;
  }
  return geometry == 0 ? 1.0 : static_cast<double>(drawn) / static_cast<double>(geometry);
}

}  // namespace

Quality compare(const render::Picture& truth, const render::Picture& view) {
  return {.mssim = render::mssim(truth, view),
          .psnr = std::min(render::psnr(truth, view), kHighestPsnr),
          .coverage = coverage(truth, view)};
}

QualitySummary summarize(const std::vector<Quality>& samples) {
  if (samples.empty()) return {};
  QualitySummary s{.count = samples.size(), .mssim_lowest = samples.front().mssim};
  for (const Quality& q : samples) {
    s.mssim += q.mssim;
    s.psnr += q.psnr;
    s.coverage += q.coverage;
    s.mssim_lowest = std::min(s.mssim_lowest, q.mssim);
  }
  const auto n = static_cast<double>(samples.size());
  s.mssim /= n;
  s.psnr /= n;
  s.coverage /= n;
  return s;
}

Notable notable(const std::vector<Quality>& samples) {
  std::vector<std::size_t> order(samples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return samples[i].mssim; });
  return {.worst = order.front(), .median = order[order.size() / 2], .last = samples.size() - 1};
}

}  // namespace atlaswire::client
