#include "lab/curve_fit.h"

#include "base/assert.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace atlaswire::lab {

namespace {

using Cubic = std::array<double, 4>;  ///< coefficients of 1, t, t^2, t^3

double antiderivative(const Cubic& c, double t) {
  return t * (c[0] + t * (c[1] / 2 + t * (c[2] / 3 + t * c[3] / 4)));
}

/// Solves m c = v by elimination with pivoting.
Cubic solved(std::array<Cubic, 4> m, Cubic v) {
  for (std::size_t k = 0; k < 4; ++k) {
    std::size_t pivot = k;
    for (std::size_t r = k + 1; r < 4; ++r) {
      if (std::abs(m[r][k]) > std::abs(m[pivot][k])) pivot = r;
    }
    std::swap(m[k], m[pivot]);
    std::swap(v[k], v[pivot]);
    for (std::size_t r = 0; r < 4; ++r) {
      if (r == k) continue;
      const double factor = m[r][k] / m[k][k];
      for (std::size_t c = k; c < 4; ++c) m[r][c] -= factor * m[k][c];
      v[r] -= factor * v[k];
    }
  }
  for (std::size_t k = 0; k < 4; ++k) v[k] /= m[k][k];
  return v;
}

/// Least squares over t = (x - middle) / half in [-1, 1], which keeps the normal equations well conditioned.
double polynomial_integral(std::span<const double> x, std::span<const double> y, double from, double to) {
  const double middle = (x.front() + x.back()) / 2;
  const double half = (x.back() - x.front()) / 2;
  std::array<Cubic, 4> normal{};
  Cubic right{};
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double t = (x[i] - middle) / half;
    const Cubic powers{1, t, t * t, t * t * t};
    for (std::size_t r = 0; r < 4; ++r) {
      right[r] += powers[r] * y[i];
      for (std::size_t c = 0; c < 4; ++c) normal[r][c] += powers[r] * powers[c];
    }
  }
  const Cubic fit = solved(normal, right);
  return half * (antiderivative(fit, (to - middle) / half) - antiderivative(fit, (from - middle) / half));
}

/// Slope of pchip at an end, from the two nearest intervals and their secants.
double pchip_end(double h0, double h1, double d0, double d1) {
  const double slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
  if (slope * d0 <= 0) return 0;
  if (d0 * d1 <= 0 && std::abs(slope) > 3 * std::abs(d0)) return 3 * d0;
  return slope;
}

std::vector<double> pchip_slopes(const std::vector<double>& h, const std::vector<double>& d) {
  const std::size_t n = d.size();
  std::vector<double> slopes(n + 1);
  slopes.front() = pchip_end(h[0], h[1], d[0], d[1]);
  slopes.back() = pchip_end(h[n - 1], h[n - 2], d[n - 1], d[n - 2]);
  for (std::size_t i = 1; i < n; ++i) {
    if (d[i - 1] * d[i] <= 0) continue;  // a turning point stays one
    const double w1 = 2 * h[i] + h[i - 1];
    const double w2 = h[i] + 2 * h[i - 1];
    slopes[i] = (w1 + w2) / (w1 / d[i - 1] + w2 / d[i]);
  }
  return slopes;
}

/// Two more secants are made up beyond either end, on the parabola's line.
std::vector<double> akima_slopes(const std::vector<double>& d) {
  const std::size_t n = d.size();
  std::vector<double> m(n + 4);
  std::copy(d.begin(), d.end(), m.begin() + 2);
  m[1] = 2 * m[2] - m[3];
  m[0] = 2 * m[1] - m[2];
  m[n + 2] = 2 * m[n + 1] - m[n];
  m[n + 3] = 2 * m[n + 2] - m[n + 1];
  double most = 0;
  for (std::size_t i = 0; i <= n; ++i) {
    most = std::max(most, std::abs(m[i + 3] - m[i + 2]) + std::abs(m[i + 1] - m[i]));
  }
  std::vector<double> slopes(n + 1);
  for (std::size_t i = 0; i <= n; ++i) {
    const double after = std::abs(m[i + 3] - m[i + 2]);
    const double before = std::abs(m[i + 1] - m[i]);
    // Straight on both sides (all but rounding): the weights say nothing, so take the middle.
    slopes[i] = after + before > 1e-9 * most ? (after * m[i + 1] + before * m[i + 2]) / (after + before)
                                             : (m[i + 1] + m[i + 2]) / 2;
  }
  return slopes;
}

double piecewise_integral(std::span<const double> x, std::span<const double> y, CurveFit fit, double from,
                          double to) {
  std::vector<double> h;
  std::vector<double> secants;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    h.push_back(x[i + 1] - x[i]);
    secants.push_back((y[i + 1] - y[i]) / h[i]);
  }
  const std::vector<double> slopes =
      fit == CurveFit::kPchip ? pchip_slopes(h, secants) : akima_slopes(secants);
  double sum = 0;
  for (std::size_t i = 0; i < h.size(); ++i) {
    const double begin = std::clamp(from, x[i], x[i + 1]) - x[i];
    const double end = std::clamp(to, x[i], x[i + 1]) - x[i];
    const double c2 = (3 * secants[i] - 2 * slopes[i] - slopes[i + 1]) / h[i];
    const double c3 = (slopes[i] + slopes[i + 1] - 2 * secants[i]) / (h[i] * h[i]);
    const Cubic piece{y[i], slopes[i], c2, c3};
    sum += antiderivative(piece, end) - antiderivative(piece, begin);
  }
  return sum;
}

}  // namespace

double curve_integral(std::span<const double> x, std::span<const double> y, CurveFit fit, double from,
                      double to) {
  AW_ASSERT(x.size() >= 4 && x.size() == y.size());
  AW_ASSERT(x.front() <= from && from <= to && to <= x.back());
  return fit == CurveFit::kCubic ? polynomial_integral(x, y, from, to)
                                 : piecewise_integral(x, y, fit, from, to);
}

}  // namespace atlaswire::lab
