#include "render/image/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

namespace atlaswire::render {

namespace {

constexpr double kPi = std::numbers::pi;

/// One Gaussian of a contrast sensitivity function: a sqrt(pi / b) exp(-pi^2 d^2 / b), d in degrees.
struct Lobe {
  double a;
  double b;
};
constexpr Lobe kAchromatic{1, 0.0047};
constexpr Lobe kRedGreen{1, 0.0053};
constexpr Lobe kBlueYellow[] = {{34.1, 0.04}, {13.5, 0.025}};
constexpr double kWidestB = 0.04;

/// Peak to trough of the human edge detector, in degrees: two standard deviations.
constexpr double kEdgeWidth = 0.082;

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum;
}

Taps scaled(const std::vector<double>& values, double factor) {
  Taps taps;
  for (const double v : values) taps.push_back(static_cast<float>(v * factor));
  return taps;
}

std::vector<double> gaussian(int radius, double sigma) {
  std::vector<double> values;
  for (int x = -radius; x <= radius; ++x) values.push_back(std::exp(-0.5 * x * x / (sigma * sigma)));
  return values;
}

/// Ends that are zero next to the middle in float: dropping them changes no sum.
void trim(std::vector<double>& values) {
  const double least = 1e-10 * *std::max_element(values.begin(), values.end());
  while (values.size() > 1 && values.front() < least) {
    values.erase(values.begin());
    values.pop_back();
  }
}

std::vector<SeparableFilter> lobes(std::initializer_list<Lobe> functions, int radius,
                                   double pixels_per_degree) {
  std::vector<std::vector<double>> axes;
  std::vector<double> volumes;
  for (const Lobe& lobe : functions) {
    std::vector<double> axis = gaussian(radius, std::sqrt(lobe.b / 2) / kPi * pixels_per_degree);
    trim(axis);
    const double sum = sum_of(axis);
    volumes.push_back(lobe.a * std::sqrt(kPi / lobe.b) * sum * sum);
    axes.push_back(std::move(axis));
  }
  const double total = sum_of(volumes);
  std::vector<SeparableFilter> filters;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double sum = sum_of(axes[i]);
    filters.push_back({scaled(axes[i], 1 / sum), scaled(axes[i], volumes[i] / total / sum)});
  }
  return filters;
}

/// Positive weights to a sum of 1, negative ones to -1.
Taps balanced(const std::vector<double>& values) {
  double positive = 0;
  double negative = 0;
  for (const double v : values) (v > 0 ? positive : negative) += std::abs(v);
  Taps taps;
  for (const double v : values) taps.push_back(static_cast<float>(v / (v > 0 ? positive : negative)));
  return taps;
}

}  // namespace

ContrastSensitivity contrast_sensitivity(double pixels_per_degree) {
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(kWidestB / 2) / kPi * pixels_per_degree));
  return {.achromatic = lobes({kAchromatic}, radius, pixels_per_degree),
          .red_green = lobes({kRedGreen}, radius, pixels_per_degree),
          .blue_yellow = lobes({kBlueYellow[0], kBlueYellow[1]}, radius, pixels_per_degree)};
}

FeatureDetectors feature_detectors(double pixels_per_degree) {
  const double sigma = 0.5 * kEdgeWidth * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const std::vector<double> smooth = gaussian(radius, sigma);
  std::vector<double> edge = smooth;
  std::vector<double> point = smooth;
  for (int x = -radius; x <= radius; ++x) {
    const auto i = static_cast<std::size_t>(x + radius);
    edge[i] *= -x;
    point[i] *= x * x / (sigma * sigma) - 1;
  }
  return {.smooth = scaled(smooth, 1 / sum_of(smooth)), .edge = balanced(edge), .point = balanced(point)};
}

}  // namespace atlaswire::render
