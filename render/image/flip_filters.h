#pragma once

#include <vector>

namespace atlaswire::render {

/// Weights along one axis, an odd number, the middle one at the output pixel.
using Taps = std::vector<float>;

/// A filter that is the product of its axes: weight(x, y) = horizontal[x] * vertical[y].
struct SeparableFilter {
  Taps horizontal;
  Taps vertical;
};

/// Contrast sensitivity of the eye per opponent channel as sums of Gaussians (FLIP, section 4.1.1, eq. 2
/// and table 1), each list summing to 1 over the square that the paper evaluates.
struct ContrastSensitivity {
  std::vector<SeparableFilter> achromatic;   ///< one Gaussian
  std::vector<SeparableFilter> red_green;    ///< one Gaussian
  std::vector<SeparableFilter> blue_yellow;  ///< two
};
ContrastSensitivity contrast_sensitivity(double pixels_per_degree);

/// First and second derivative of a Gaussian of the width that human edge detection has (FLIP, section
/// 4.2), across x: positive weights sum to 1 and negative ones to -1. Swap the axes for y.
struct FeatureDetectors {
  Taps smooth;  ///< the other axis of both; sums to 1
  Taps edge;
  Taps point;
};
FeatureDetectors feature_detectors(double pixels_per_degree);

}  // namespace atlaswire::render
