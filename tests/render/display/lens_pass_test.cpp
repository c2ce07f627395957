#include "render/display/lens_pass.h"

#include "base/random.h"
#include "render/gpu/offscreen_target.h"
#include "tests/render/display/round_trip.h"
#include "tests/render/gpu/gpu_fixture.h"
#include "tests/render/passes/scene_builder.h"

#include <cmath>
#include <numbers>

namespace atlaswire::render {
namespace {

constexpr Rgba8 kWhite{255, 255, 255, 255};

Picture noise(std::uint64_t seed, Extent2D extent) {
  Random random(seed);
  Picture picture(extent);
  for (auto& byte : picture.rgba) byte = static_cast<std::uint8_t>(random.below(256));
  return picture;
}

/// Mean position of a channel's light within columns [left, left + width), in pixels from `left`.
glm::dvec2 centroid(const Picture& picture, std::uint32_t left, std::uint32_t width, std::size_t channel) {
  glm::dvec2 sum{0};
  double weight = 0;
  for (std::uint32_t y = 0; y < picture.extent.height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const double light = picture.at(left + x, y)[channel];
      sum += light * glm::dvec2{x + 0.5, y + 0.5};
      weight += light;
    }
  }
  EXPECT_GT(weight, 0);
  return sum / weight;
}

class LensPassTest : public test::GpuTest {
 protected:
  /// A target that holds exactly these pixels.
  std::unique_ptr<OffscreenTarget> holding(const Picture& picture) {
    auto target = std::make_unique<OffscreenTarget>(device(), "painted", picture.extent);
    SubmitContext context(device(), "painting");
    context.run([&](const vk::raii::CommandBuffer& commands) {
      target->begin(commands, {0, 0, 0});
      for (std::uint32_t y = 0; y < picture.extent.height; ++y) {
        for (std::uint32_t x = 0; x < picture.extent.width; ++x) {
          if (const Rgba8 colour = picture.at(x, y); colour != Rgba8{}) dot(commands, x, y, colour);
        }
      }
      commands.endRendering();
    });
    return target;
  }

 private:
  static void dot(const vk::raii::CommandBuffer& commands, std::uint32_t x, std::uint32_t y, Rgba8 colour) {
    std::array<float, 4> value{};
    for (std::size_t c = 0; c < 4; ++c) value[c] = static_cast<float>(colour[c]) / 255.0F;
    const vk::ClearAttachment attachment{.aspectMask = vk::ImageAspectFlagBits::eColor,
                                         .clearValue = vk::ClearColorValue(value)};
    const vk::ClearRect rectangle{
        .rect = {.offset = {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)}, .extent = {1, 1}},
        .layerCount = 1};
    commands.clearAttachments(attachment, rectangle);
  }
};

TEST_F(LensPassTest, WithoutDistortionPutsEachEyeIntoItsHalfUnchanged) {
  const Extent2D extent{37, 24};
  const Picture left = noise(1, extent);
  const Picture right = noise(2, extent);
  LensPass lens(device(), {}, 2);
  EXPECT_TRUE(lens.read_back().empty());
  lens.apply(*holding(left), Eye::kLeft);
  lens.apply(*holding(right), Eye::kRight);
  const Picture& both = lens.read_back();
  ASSERT_EQ(both.extent, (Extent2D{74, 24}));
  for (std::uint32_t y = 0; y < 24; ++y) {
    for (std::uint32_t x = 0; x < 37; ++x) {
      ASSERT_EQ(both.at(x, y), left.at(x, y)) << x << ',' << y;
      ASSERT_EQ(both.at(37 + x, y), right.at(x, y)) << x << ',' << y;
    }
  }
}

TEST_F(LensPassTest, OneEyeFillsThePictureAndExtentsMayChange) {
  LensPass lens(device(), {}, 1);
  for (const Extent2D extent : {Extent2D{16, 16}, Extent2D{20, 12}}) {
    const Picture eye = noise(3, extent);
    lens.apply(*holding(eye), Eye::kLeft);
    EXPECT_EQ(lens.read_back(), eye);
  }
}

// A point that was rendered at radius r' appears where r (1 + k1 r^2 + k2 r^4) = r'.
TEST_F(LensPassTest, MovesPointsAsTheirChannelsCoefficientsSay) {
  const Extent2D extent{160, 128};
  const LensCorrection correction{{{{0.1, 0.05}, {0.3, 0.1}, {-0.08, 0.02}}}};
  const glm::dvec2 centre{80, 64};
  for (const glm::dvec2 at : {glm::dvec2{122.5, 90.5}, glm::dvec2{40.5, 30.5}, glm::dvec2{80.5, 100.5}}) {
    Picture picture(extent, {0, 0, 0, 0});
    for (int v = -1; v <= 1; ++v) {
      for (int u = -1; u <= 1; ++u) {
        picture.set(static_cast<std::uint32_t>(int(at.x) + u), static_cast<std::uint32_t>(int(at.y) + v),
                    kWhite);
      }
    }
    const auto eye = holding(picture);
    LensPass lens(device(), correction, 2);
    lens.apply(*eye, Eye::kLeft);
    lens.apply(*eye, Eye::kRight);
    const Picture& seen = lens.read_back();
    const double rendered = glm::length(at - centre) / 64;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [k1, k2] = correction.channels[c];
      double low = 0;
      double high = 2;
      for (int i = 0; i < 60; ++i) {
        const double r = (low + high) / 2;
        (r * (1 + k1 * r * r + k2 * r * r * r * r) < rendered ? low : high) = r;
      }
      const glm::dvec2 expected = centre + (at - centre) * (low / rendered);
      for (const std::uint32_t left : {0U, extent.width}) {
        const glm::dvec2 found = centroid(seen, left, extent.width, c);
        EXPECT_NEAR(found.x, expected.x, 0.12) << "channel " << c;
        EXPECT_NEAR(found.y, expected.y, 0.12) << "channel " << c;
      }
    }
  }
}

TEST_F(LensPassTest, ShowsNothingFromBeyondThePicture) {
  LensPass lens(device(), {{{{0, 0}, {0.5, 0}, {0, 0}}}}, 1);
  lens.apply(*holding(Picture({32, 32}, kWhite)), Eye::kLeft);
  const Picture& seen = lens.read_back();
  EXPECT_EQ(seen.at(0, 0), (Rgba8{255, 0, 255, 0})) << "alpha goes with green";
  EXPECT_EQ(seen.at(16, 16), kWhite);
  EXPECT_EQ(seen.at(16, 0), (Rgba8{255, 0, 255, 0})) << "r = 1 looks at r' = 1.5";
  EXPECT_EQ(seen.at(16, 4), kWhite) << "r = 0.72 looks at r' = 0.91";
}

// A plane at a distance d is displaced between the eyes by focal length times ipd / d.
TEST_F(LensPassTest, EyesSeeAPlaneWithTheDisparityOfItsDepth) {
  const Extent2D extent{256, 128};
  const double ipd = 0.064;
  const double focal = 64 / std::tan(0.5);  // pixels
  for (const double distance : {0.5, 1.0, 4.0}) {
    test::SceneBuilder builder;
    const std::uint16_t m = builder.material(test::glowing({9, 9, 9}));
    builder.rectangle(m, {-0.2F, -0.1F, static_cast<float>(-distance)}, {0.4F, 0, 0}, {0, 0.2F, 0});
    test::RoundTrip trip(device(), builder.build(), {64, 64});
    const std::vector<PlacedPatch> placed{{PatchId{0}, Block{0, 0, 4, 4}}};
    Camera head{.vertical_fov = 1.0, .extent = extent};
    std::array<glm::dvec2, 2> seen{};
    for (const Eye eye : {Eye::kLeft, Eye::kRight}) {
      const Picture picture = trip.display(placed, eye_camera(head, eye, ipd));
      seen[static_cast<std::size_t>(eye)] = centroid(picture, 0, extent.width, 3);
    }
    EXPECT_NEAR(seen[0].x - seen[1].x, focal * ipd / distance, 0.5) << distance;
    EXPECT_NEAR((seen[0].x + seen[1].x) / 2, 128, 0.5);
    EXPECT_NEAR(seen[0].y, seen[1].y, 0.05);
  }
}

TEST(EyeCamera, OffsetsAlongTheHeadsRight) {
  Camera head;
  head.pose.position = {5, 6, 7};
  head.pose.orientation = glm::angleAxis(std::numbers::pi / 2, glm::dvec3{0, 1, 0});  // looks along -x
  const Camera left = eye_camera(head, Eye::kLeft, 0.06);
  const Camera right = eye_camera(head, Eye::kRight, 0.06);
  EXPECT_NEAR(glm::length(left.pose.position - glm::dvec3(5, 6, 7.03)), 0, 1e-12);
  EXPECT_NEAR(glm::length(right.pose.position - glm::dvec3(5, 6, 6.97)), 0, 1e-12);
  EXPECT_EQ(left.pose.orientation, head.pose.orientation);
  EXPECT_EQ(left.extent, head.extent);
}

}  // namespace
}  // namespace atlaswire::render
