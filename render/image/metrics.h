#pragma once

#include "render/image/picture.h"

#include <vector>

namespace atlaswire::render {

/// Structural similarity as [SAS] 5.6 sets it (Wang et al. 2004): Gaussian window of 11 x 11 pixels with
/// sigma 2, C1 = 0.0001, C2 = 0.0009, which is (0.01)^2 and (0.03)^2 for values in [0, 1]. The paper does
/// not say of which channel: we take BT.709 luma of the sRGB-encoded colours. Windows lie wholly inside
/// the pictures: the outer 5 pixels are centres of none. Alpha does not count.
struct SsimMap {
  Extent2D extent;            ///< width - 10 by height - 10; empty if a side is below 11
  std::vector<float> values;  ///< (-1, 1], rows from the top
};

/// The index at each window. Both pictures have one extent.
SsimMap ssim_map(const Picture& reference, const Picture& picture);

/// Mean of `ssim_map`: MSSIM of one frame. NaN if a side is below 11 pixels.
double mssim(const Picture& reference, const Picture& picture);

/// Structural dissimilarity of an MSSIM value: 0 for equal pictures, larger is worse, 1 at most.
constexpr double dssim(double mssim_value) { return (1 - mssim_value) / 2; }

/// Peak signal-to-noise ratio in dB over red, green and blue together; infinity for equal pictures, NaN
/// for empty ones.
double psnr(const Picture& reference, const Picture& picture);

/// What is shown at one moment, and what should have been. Neither is null; all of one extent.
struct ShownPair {
  const Picture* reference = nullptr;
  const Picture* picture = nullptr;
};

/// Flicker between two successive displayed frames: mean over the pixels of |(v1 - v0) - (r1 - r0)|, with v
/// the shown and r the reference's BT.709 luma of sRGB-encoded colours in [0, 1]. 0: the picture changes as
/// the reference does, however wrong both its frames are; 2 at most. NaN for empty pictures.
double flicker(const ShownPair& before, const ShownPair& now);

/// Share of pixels, 0..1, whose alpha is 0: nothing was drawn there. 0 for an empty picture.
double hole_share(const Picture& picture);

}  // namespace atlaswire::render
