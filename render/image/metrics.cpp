#include "render/image/metrics.h"

#include "base/assert.h"
#include "render/image/weighted_sum.h"

#include <array>
#include <cmath>
#include <limits>

namespace atlaswire::render {

namespace {

constexpr std::uint32_t kWindow = 11;
constexpr std::uint32_t kBorder = kWindow - 1;
constexpr double kSigma = 2.0;
constexpr float kC1 = 0.0001F;
constexpr float kC2 = 0.0009F;
/// Local sums of one row: x, y, x^2 + y^2, x y. SSIM needs the two variances only as a sum.
constexpr std::size_t kMoments = 4;

/// One axis of the separable window; sums to 1.
std::array<float, kWindow> gaussian() {
  std::array<double, kWindow> w{};
  double sum = 0;
  for (std::uint32_t i = 0; i < kWindow; ++i) {
    const double d = (double{1} * i - 5.0) / kSigma;
    w[i] = std::exp(-0.5 * d * d);
    sum += w[i];
  }
  std::array<float, kWindow> out{};
  for (std::uint32_t i = 0; i < kWindow; ++i) out[i] = static_cast<float>(w[i] / sum);
  return out;
}

/// BT.709 luma of the sRGB-encoded colours, in [0, 1].
float luma(const std::uint8_t* rgba) {
  return 0.2126F / 255 * static_cast<float>(rgba[0]) + 0.7152F / 255 * static_cast<float>(rgba[1]) +
         0.0722F / 255 * static_cast<float>(rgba[2]);
}

/// Luma of one row, less a half: small numbers lose fewer digits when squares are subtracted.
void centred_luma(const Picture& image, std::uint32_t y, float* out) {
  const std::uint8_t* p = &image.rgba[std::size_t{y} * image.extent.width * 4];
  for (std::uint32_t x = 0; x < image.extent.width; ++x, p += 4) out[x] = luma(p) - 0.5F;
}

/// Keeps the horizontally filtered moments of the last eleven rows and joins them vertically.
class SlidingWindow {
 public:
  SlidingWindow(const Picture& a, const Picture& b)
      : a_(a),
        b_(b),
        width_(a.extent.width),
        count_(width_ - kBorder),
        raw_(kMoments * width_),
        ring_(kWindow * kMoments * count_),
        sums_(kMoments * count_) {}

  void add_row(std::uint32_t y) {
    float* x1 = raw_.data();
    float* x2 = x1 + width_;
    float* squares = x2 + width_;
    float* product = squares + width_;
    centred_luma(a_, y, x1);
    centred_luma(b_, y, x2);
    for (std::uint32_t x = 0; x < width_; ++x) {
      squares[x] = x1[x] * x1[x] + x2[x] * x2[x];
      product[x] = x1[x] * x2[x];
    }
    for (std::size_t m = 0; m < kMoments; ++m) {
      weighted_sum_along(weights_, raw_.data() + m * width_, count_, slot(y) + m * count_);
    }
  }

  /// SSIM of the windows whose last row is `y`.
  void emit(std::uint32_t y, float* out) {
    std::array<const float*, kWindow> rows{};
    for (std::uint32_t i = 0; i < kWindow; ++i) rows[i] = slot(y - kBorder + i);
    weighted_sum(weights_, rows.data(), kMoments * count_, sums_.data());
    const float* mean1 = sums_.data();
    const float* mean2 = mean1 + count_;
    const float* squares = mean2 + count_;
    const float* product = squares + count_;
    for (std::uint32_t x = 0; x < count_; ++x) {
      const float variances = squares[x] - mean1[x] * mean1[x] - mean2[x] * mean2[x];
      const float covariance = product[x] - mean1[x] * mean2[x];
      const float m1 = mean1[x] + 0.5F;
      const float m2 = mean2[x] + 0.5F;
      out[x] = (2 * m1 * m2 + kC1) * (2 * covariance + kC2) / ((m1 * m1 + m2 * m2 + kC1) * (variances + kC2));
    }
  }

 private:
  float* slot(std::uint32_t y) { return ring_.data() + std::size_t{y % kWindow} * kMoments * count_; }

  const Picture& a_;
  const Picture& b_;
  std::uint32_t width_;
  std::uint32_t count_;
  std::vector<float> raw_;
  std::vector<float> ring_;
  std::vector<float> sums_;
  std::array<float, kWindow> weights_ = gaussian();
};

}  // namespace

SsimMap ssim_map(const Picture& reference, const Picture& picture) {
  AW_ASSERT(reference.extent == picture.extent);
  const Extent2D extent = reference.extent;
  SsimMap map;
  if (extent.width < kWindow || extent.height < kWindow) return map;
  map.extent = {extent.width - kBorder, extent.height - kBorder};
  map.values.resize(map.extent.area());
  SlidingWindow window(reference, picture);
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    window.add_row(y);
    if (y >= kBorder) window.emit(y, &map.values[std::size_t{y - kBorder} * map.extent.width]);
  }
  return map;
}

double mssim(const Picture& reference, const Picture& picture) {
  const SsimMap map = ssim_map(reference, picture);
  if (map.values.empty()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  for (const float value : map.values) sum += value;
  return sum / static_cast<double>(map.values.size());
}

double psnr(const Picture& reference, const Picture& picture) {
  AW_ASSERT(reference.extent == picture.extent);
  if (reference.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::uint64_t squares = 0;
  for (std::size_t i = 0; i < reference.rgba.size(); i += 4) {
    for (std::size_t c = 0; c < 3; ++c) {
      const int d = int{reference.rgba[i + c]} - int{picture.rgba[i + c]};
      squares += static_cast<std::uint64_t>(d * d);
    }
  }
  if (squares == 0) return std::numeric_limits<double>::infinity();
  const double mean = static_cast<double>(squares) / (3.0 * static_cast<double>(reference.extent.area()));
  return 10 * std::log10(255.0 * 255.0 / mean);
}

double flicker(const ShownPair& before, const ShownPair& now) {
  const Extent2D extent = before.reference->extent;
  AW_ASSERT(before.picture->extent == extent && now.reference->extent == extent &&
            now.picture->extent == extent);
  if (extent.area() == 0) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  for (std::size_t i = 0; i < before.reference->rgba.size(); i += 4) {
    const float expected = luma(&now.reference->rgba[i]) - luma(&before.reference->rgba[i]);
    const float shown = luma(&now.picture->rgba[i]) - luma(&before.picture->rgba[i]);
    sum += std::abs(shown - expected);
  }
  return sum / static_cast<double>(extent.area());
}

double hole_share(const Picture& picture) {
  if (picture.empty()) return 0;
  std::uint64_t holes = 0;
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) holes += picture.rgba[i] == 0 ? 1 : 0;
  return static_cast<double>(holes) / static_cast<double>(picture.extent.area());
}

}  // namespace atlaswire::render
