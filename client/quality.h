#pragma once

#include "base/ids.h"
#include "render/image/picture.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace atlaswire::client {

/// How one displayed frame compares with ground truth for its pose.
struct Quality {
  FrameId frame{};
  std::uint64_t display_index = 0;
  double mssim = 0;
  double psnr = 0;  ///< dB, at most 99
  double coverage =
      1;  ///< share of the truth's geometry pixels where the client drew something; 1 without any
};

/// Both pictures of one extent, at least 11 x 11.
Quality compare(const render::Picture& truth, const render::Picture& view);

/// Means over samples; `count` 0: nothing was compared.
struct QualitySummary {
  std::size_t count = 0;
  double mssim = 0;
  double mssim_lowest = 0;
  double psnr = 0;
  double coverage = 0;
};
QualitySummary summarize(const std::vector<Quality>& samples);

/// Which samples are worth looking at: lowest and median MSSIM, and the last. Indices; not empty input.
struct Notable {
  std::size_t worst = 0;
  std::size_t median = 0;
  std::size_t last = 0;
};
Notable notable(const std::vector<Quality>& samples);

}  // namespace atlaswire::client
