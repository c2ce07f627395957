#pragma once

#include "render/image/picture.h"

#include <numbers>
#include <vector>

namespace atlaswire::render {

/// The paper's viewer: 0.7 m from a display 0.7 m and 3840 pixels wide, 67 pixels per degree. A picture that
/// spans 90 degrees with 960 pixels has 8.4 at its centre (480 pixels / tan 45 degrees, per degree).
inline constexpr double kFlipPixelsPerDegree = 0.7 * (3840 / 0.7) * std::numbers::pi / 180;

/// LDR-FLIP of Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020: how large
/// the difference at each pixel looks to someone who flips between the pictures. Alpha does not count.
/// The paper's constants, in float with separable filters; borders repeat.
struct FlipMap {
  Extent2D extent;            ///< the pictures'
  std::vector<float> values;  ///< 0 (equal) .. 1, rows from the top
};

/// Both pictures have one extent. `pixels_per_degree` 1..1000: wider filters for sharper displays.
FlipMap flip_map(const Picture& reference, const Picture& picture,
                 double pixels_per_degree = kFlipPixelsPerDegree);

/// Mean of `flip_map`; NaN for empty pictures.
double flip(const Picture& reference, const Picture& picture,
            double pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace atlaswire::render
