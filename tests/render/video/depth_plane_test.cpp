#include "render/video/depth_plane.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace atlaswire::render {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A 2 x 2 depth plane below black colours, its rows `padding` octets apart.
struct Plane {
  explicit Plane(std::span<const std::uint8_t> lower, std::uint32_t padding = 0) : stride(2 + padding) {
    luma.assign(std::size_t{4} * stride, 77);
    for (std::size_t i = 0; i < 4; ++i) luma[(2 + i / 2) * stride + i % 2] = lower[i];
  }
  [[nodiscard]] I420Planes view() const { return {{2, 4}, luma.data(), nullptr, nullptr, stride, 1}; }

  std::uint32_t stride;
  std::vector<std::uint8_t> luma;
};

std::vector<float> round_trip(const std::vector<float>& depth, double nearest, std::uint32_t padding = 0) {
  std::vector<std::uint8_t> luma(4);
  encode_depth_plane(depth, nearest, luma);
  std::vector<float> decoded;
  decode_depth_plane(Plane(luma, padding).view(), nearest, decoded);
  return decoded;
}

TEST(DepthPlane, HoldsInverseDistanceAndZeroForNothing) {
  std::vector<std::uint8_t> luma(4);
  encode_depth_plane(std::vector{0.5F, 1.0F, 5.0F, kInfinity}, 0.5, luma);
  EXPECT_EQ(luma, (std::vector<std::uint8_t>{255, 128, 26, 0}));
}

TEST(DepthPlane, RoundTripErrsByWhatIsDocumented) {
  for (const double nearest : {0.05, 0.3, 4.0}) {
    for (double factor = 1; factor < 500; factor *= 1.07) {
      const auto z = static_cast<float>(nearest * factor);
      const float decoded = round_trip({z, z, z, z}, nearest)[0];
      EXPECT_LE(std::abs(1 / decoded - 1 / z), 1.0001 / (510 * nearest)) << z;
    }
  }
}

TEST(DepthPlane, RowsMayBePadded) {
  const std::vector<float> depth{1, 2, 4, kInfinity};
  EXPECT_EQ(round_trip(depth, 1), round_trip(depth, 1, 30));
  EXPECT_EQ(round_trip(depth, 1)[3], kInfinity);
}

TEST(DepthPlane, AnyOctetsGiveDistancesAboveZero) {
  for (int value = 0; value < 256; ++value) {
    const auto octet = static_cast<std::uint8_t>(value);
    std::vector<float> decoded;
    decode_depth_plane(Plane(std::vector(4, octet)).view(), 0.1, decoded);
    for (const float z : decoded) EXPECT_GE(z, 0.0999F);
  }
}

TEST(DepthPlane, APictureOfNothingStaysOne) {
  const double nearest = depth_plane_nearest(std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isinf(nearest));
  const std::vector<float> nothing(4, kInfinity);
  EXPECT_EQ(round_trip(nothing, nearest), nothing);
}

TEST(DepthPlane, NearestIsRoundedDownToAFewValues) {
  for (double nearest = 0.05; nearest < 40; nearest *= 1.013) {
    const double rounded = depth_plane_nearest(nearest);
    EXPECT_LE(rounded, nearest);
    EXPECT_GT(rounded * std::exp2(0.25), nearest);
    EXPECT_NEAR(std::log2(rounded) * 4, std::round(std::log2(rounded) * 4), 1e-9);
  }
}

TEST(DepthPlane, UpperHalfIsTheColours) {
  const Plane plane(std::vector<std::uint8_t>{1, 2, 3, 4});
  const I420Planes upper = upper_half(plane.view());
  EXPECT_EQ(upper.extent, (Extent2D{2, 2}));
  EXPECT_EQ(upper.y, plane.luma.data());
}

}  // namespace
}  // namespace atlaswire::render
