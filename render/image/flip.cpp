#include "render/image/flip.h"

#include "base/assert.h"
#include "render/image/flip_filters.h"
#include "render/image/plane.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace atlaswire::render {

namespace {

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;

/// Linear sRGB to CIE XYZ under D65, each row divided by its sum: (1, 1, 1) is white. The rational numbers
/// are those of the paper's implementation.
constexpr Matrix kToXyz{{{10135552.0 / 23359437, 8788810.0 / 23359437, 4435075.0 / 23359437},
                         {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                         {1425312.0 / 80288307, 8788810.0 / 80288307, 70074185.0 / 80288307}}};

constexpr Matrix inverse(const Matrix& m) {
  Matrix out{};
  double determinant = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t r1 = (j + 1) % 3, r2 = (j + 2) % 3, c1 = (i + 1) % 3, c2 = (i + 2) % 3;
      out[i][j] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
    }
  }
  for (std::size_t j = 0; j < 3; ++j) determinant += m[0][j] * out[j][0];
  for (Vector& row : out) {
    for (double& value : row) value /= determinant;
  }
  return out;
}
constexpr Matrix kToRgb = inverse(kToXyz);

float row_of(const Matrix& m, std::size_t i, float a, float b, float c) {
  return static_cast<float>(m[i][0]) * a + static_cast<float>(m[i][1]) * b + static_cast<float>(m[i][2]) * c;
}

/// The opponent colours Yy, Cx, Cz less their scales and offset, which cancel: the filters are linear and
/// sum to 1, and CIELAB divides by the same numbers again.
struct Opponent {
  explicit Opponent(Extent2D extent) : y(extent), red_green(extent), blue_yellow(extent) {}
  Plane y;            ///< Y
  Plane red_green;    ///< X - Y
  Plane blue_yellow;  ///< Y - Z
};

std::array<float, 256> linear_light() {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < 256; ++i) {
    const double v = static_cast<double>(i) / 255;
    table[i] = static_cast<float>(v > 0.04045 ? std::pow((v + 0.055) / 1.055, 2.4) : v / 12.92);
  }
  return table;
}

Opponent opponent_colours(const Picture& picture) {
  const std::array<float, 256> linear = linear_light();
  Opponent out(picture.extent);
  const std::uint8_t* p = picture.rgba.data();
  for (std::size_t i = 0; i < out.y.values.size(); ++i, p += 4) {
    const float r = linear[p[0]];
    const float g = linear[p[1]];
    const float b = linear[p[2]];
    const float y = row_of(kToXyz, 1, r, g, b);
    out.y.values[i] = y;
    out.red_green.values[i] = row_of(kToXyz, 0, r, g, b) - y;
    out.blue_yellow.values[i] = y - row_of(kToXyz, 2, r, g, b);
  }
  return out;
}

Plane filtered(const Plane& in, const std::vector<SeparableFilter>& lobes) {
  Plane sum(in.extent);
  for (const SeparableFilter& lobe : lobes) {
    const Plane part = filtered_along_columns(filtered_along_rows(in, lobe.horizontal), lobe.vertical);
    for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += part.values[i];
  }
  return sum;
}

/// Cube root of t in [0.005, 1], to float's precision: a first guess from the exponent, then Halley's step
/// twice. Without branches or calls, so that loops over pixels become vector code.
float cube_root(float t) {
  const auto third = static_cast<std::int32_t>(static_cast<float>(std::bit_cast<std::int32_t>(t)) / 3);
  float root = std::bit_cast<float>(third + 709921077);
  for (int i = 0; i < 2; ++i) {
    const float cube = root * root * root;
    root *= (cube + 2 * t) / (2 * cube + t);
  }
  return root;
}

/// CIELAB's response.
float lab_response(float t) {
  constexpr float kDelta = 6.0F / 29;
  const float line = t / (3 * kDelta * kDelta) + 4.0F / 29;
  const float root = cube_root(std::max(t, 0.005F));
  return t > kDelta * kDelta * kDelta ? root : line;
}

/// CIELAB after the Hunt adjustment: chroma in proportion to lightness.
struct HuntLab {
  float l, a, b;
};

HuntLab hunt_lab(float r, float g, float b) {
  const float x = lab_response(row_of(kToXyz, 0, r, g, b));
  const float y = lab_response(row_of(kToXyz, 1, r, g, b));
  const float z = lab_response(row_of(kToXyz, 2, r, g, b));
  const float l = 116 * y - 16;
  return {l, 0.01F * l * 500 * (x - y), 0.01F * l * 200 * (y - z)};
}

/// What the eye can resolve of an opponent colour, back within the colours that the display can show.
HuntLab displayed(float y, float red_green, float blue_yellow) {
  const float x = y + red_green;
  const float z = y - blue_yellow;
  const auto channel = [&](std::size_t i) { return std::clamp(row_of(kToRgb, i, x, y, z), 0.0F, 1.0F); };
  return hunt_lab(channel(0), channel(1), channel(2));
}

/// City-block distance in lightness, Euclidean in chroma (Abasi et al. 2020).
float hyab(const HuntLab& p, const HuntLab& q) {
  const float da = p.a - q.a;
  const float db = p.b - q.b;
  return std::abs(p.l - q.l) + std::sqrt(da * da + db * db);
}

/// HyAB distances to [0, 1] (section 4.1.3): compressed, and all beyond 40 % of the largest into the top 5 %.
class Redistribution {
 public:
  float operator()(float distance) const {
    const float error = std::pow(distance, kExponent);
    if (error < knee_) return kTop / knee_ * error;
    return kTop + (error - knee_) / (largest_ - knee_) * (1 - kTop);
  }

 private:
  static constexpr float kExponent = 0.7F;
  static constexpr float kTop = 0.95F;
  float largest_ = std::pow(hyab(hunt_lab(0, 1, 0), hunt_lab(0, 0, 1)), kExponent);  ///< green to blue
  float knee_ = 0.4F * largest_;
};

/// Colour distance after the eye's blur, in HyAB units, per pixel.
Plane colour_distances(const Opponent& reference, const Opponent& picture, double pixels_per_degree) {
  const ContrastSensitivity eye = contrast_sensitivity(pixels_per_degree);
  const auto seen = [&eye](const Opponent& from) {
    Opponent to(Extent2D{});
    to.y = filtered(from.y, eye.achromatic);
    to.red_green = filtered(from.red_green, eye.red_green);
    to.blue_yellow = filtered(from.blue_yellow, eye.blue_yellow);
    return to;
  };
  const Opponent p = seen(reference);
  const Opponent q = seen(picture);
  Plane out(reference.y.extent);
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    out.values[i] = hyab(displayed(p.y.values[i], p.red_green.values[i], p.blue_yellow.values[i]),
                         displayed(q.y.values[i], q.red_green.values[i], q.blue_yellow.values[i]));
  }
  return out;
}

Plane magnitudes(const Plane& x, const Plane& y) {
  Plane out(x.extent);
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    out.values[i] = std::sqrt(x.values[i] * x.values[i] + y.values[i] * y.values[i]);
  }
  return out;
}

/// Strength of edges and of points around each pixel of Y.
struct Features {
  Plane edges;
  Plane points;
};

Features features_of(const Plane& y, const FeatureDetectors& detect) {
  const Plane smooth = filtered_along_rows(y, detect.smooth);
  const auto strength = [&](const Taps& taps) {
    return magnitudes(filtered_along_columns(filtered_along_rows(y, taps), detect.smooth),
                      filtered_along_columns(smooth, taps));
  };
  return {strength(detect.edge), strength(detect.point)};
}

}  // namespace

FlipMap flip_map(const Picture& reference, const Picture& picture, double pixels_per_degree) {
  AW_ASSERT(reference.extent == picture.extent);
  AW_ASSERT(pixels_per_degree >= 1 && pixels_per_degree <= 1000);
  if (reference.empty()) return {};
  const Opponent p = opponent_colours(reference);
  const Opponent q = opponent_colours(picture);
  const FeatureDetectors detect = feature_detectors(pixels_per_degree);
  const Features a = features_of(p.y, detect);
  const Features b = features_of(q.y, detect);
  const Redistribution redistribute;
  FlipMap map{reference.extent, colour_distances(p, q, pixels_per_degree).values};
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    const float edges = std::abs(a.edges.values[i] - b.edges.values[i]);
    const float points = std::abs(a.points.values[i] - b.points.values[i]);
    const float feature = std::sqrt(std::max(edges, points) / std::numbers::sqrt2_v<float>);
    map.values[i] = std::pow(redistribute(map.values[i]), 1 - std::min(feature, 1.0F));
  }
  return map;
}

double flip(const Picture& reference, const Picture& picture, double pixels_per_degree) {
  const FlipMap map = flip_map(reference, picture, pixels_per_degree);
  if (map.values.empty()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  for (const float value : map.values) sum += value;
  return sum / static_cast<double>(map.values.size());
}

}  // namespace atlaswire::render
