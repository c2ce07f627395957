#pragma once

#include <span>

namespace atlaswire::lab {

/// How a curve runs through its points.
enum class CurveFit {
  kCubic,  ///< one polynomial of degree 3, by least squares where there are more than four points
  kPchip,  ///< piecewise cubics that never overshoot (Fritsch and Butland 1984; MATLAB's and SciPy's pchip)
  kAkima,  ///< piecewise cubics with local slopes (Akima 1970; SciPy's Akima1DInterpolator)
};

/// The integral from `from` to `to` of the curve through (x[i], y[i]). x ascends strictly, at least four of
/// them; x.front() <= from <= to <= x.back().
double curve_integral(std::span<const double> x, std::span<const double> y, CurveFit fit, double from,
                      double to);

}  // namespace atlaswire::lab
