#include "render/passes/i420_pass.h"

#include "base/program.h"
#include "base/random.h"
#include "render/gpu/submit_context.h"
#include "tests/render/gpu/gpu_fixture.h"
#include "tests/render/passes/picture_checks.h"

namespace atlaswire::render {
namespace {

class I420PassTest : public test::GpuTest {
 protected:
  I420PassTest() : context_(device(), "i420 test", 1) {}

  Image image_of(const Picture& picture) {
    Image image(device(), {.name = "i420 test source",
                           .extent = picture.extent,
                           .usage = vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst});
    const Buffer staging(device(), {.name = "i420 test staging",
                                    .size = picture.rgba.size(),
                                    .usage = vk::BufferUsageFlagBits::eTransferSrc,
                                    .residence = Residence::kUpload});
    std::memcpy(staging.mapped().data(), picture.rgba.data(), picture.rgba.size());
    staging.flush();
    context_.run([&](const vk::raii::CommandBuffer& commands) {
      use_image(commands, image, ImageUse::kTransferTarget);
      const vk::BufferImageCopy region{
          .imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1},
          .imageExtent = {picture.extent.width, picture.extent.height, 1}};
      commands.copyBufferToImage(staging.handle(), image.handle(), image.layout(), region);
      use_image(commands, image, ImageUse::kSampledInCompute);
    });
    return image;
  }

  void convert(const I420Pass& pass, std::uint32_t slot) {
    context_.run([&](const vk::raii::CommandBuffer& commands) { pass.record(commands, slot); });
  }

  SubmitContext context_;
};

Picture noise(Extent2D extent, std::uint64_t seed) {
  Random random(seed);
  Picture picture(extent);
  for (auto& octet : picture.rgba) octet = static_cast<std::uint8_t>(random.below(256));
  return picture;
}

double luma_of(const Rgba8& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

struct Means {
  double blue_chroma = 0;
  double red_chroma = 0;
};
Means chroma_of(const Picture& p, std::uint32_t x, std::uint32_t y) {
  double r = 0;
  double b = 0;
  double luma = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const Rgba8 c = p.at(2 * x + i % 2, 2 * y + i / 2);
    r += c[0] / 4.0;
    b += c[2] / 4.0;
    luma += luma_of(c) / 4.0;
  }
  return {std::clamp((b - luma) / 1.8556 + 128.0, 0.0, 255.0),
          std::clamp((r - luma) / 1.5748 + 128.0, 0.0, 255.0)};
}

TEST_F(I420PassTest, MatchesBt709FullRangeForNoise) {
  const Picture source = noise({72, 22}, 1);
  const Image image = image_of(source);
  const I420Pass pass(device(), image, I420Pass::LowerHalf::kNone, 2);
  convert(pass, 1);
  const I420Picture picture = pass.picture(1);
  ASSERT_EQ(picture.extent, (Extent2D{72, 22}));
  for (std::uint32_t y = 0; y < 22; ++y) {
    for (std::uint32_t x = 0; x < 72; ++x) {
      ASSERT_NEAR(picture.y[y * 72 + x], luma_of(source.at(x, y)), 0.51) << x << "," << y;
    }
  }
  for (std::uint32_t y = 0; y < 11; ++y) {
    for (std::uint32_t x = 0; x < 36; ++x) {
      const Means means = chroma_of(source, x, y);
      ASSERT_NEAR(picture.u[y * 36 + x], means.blue_chroma, 0.51) << x << "," << y;
      ASSERT_NEAR(picture.v[y * 36 + x], means.red_chroma, 0.51) << x << "," << y;
    }
  }
}

TEST_F(I420PassTest, PutsCoverageBelowTheColoursWithNeutralChroma) {
  const Picture source = noise({64, 16}, 2);
  const Image image = image_of(source);
  const I420Pass pass(device(), image, I420Pass::LowerHalf::kCoverage, 1);
  convert(pass, 0);
  const I420Picture picture = pass.picture(0);
  ASSERT_EQ(picture.extent, (Extent2D{64, 32}));
  for (std::uint32_t y = 0; y < 16; ++y) {
    for (std::uint32_t x = 0; x < 64; ++x) {
      ASSERT_NEAR(picture.y[y * 64 + x], luma_of(source.at(x, y)), 0.51);
      ASSERT_EQ(picture.y[(y + 16) * 64 + x], source.at(x, y)[3]);
    }
  }
  for (std::uint32_t i = 8 * 32; i < 16 * 32; ++i) {
    ASSERT_EQ(picture.u[i], 128);
    ASSERT_EQ(picture.v[i], 128);
  }
  ASSERT_NEAR(picture.v[3 * 32 + 5], chroma_of(source, 5, 3).red_chroma, 0.51);
}

TEST_F(I420PassTest, RefusesSidesThatDoNotPack) {
  const Image image = image_of(noise({60, 16}, 3));
  EXPECT_THROW((I420Pass{device(), image, I420Pass::LowerHalf::kNone, 1}), ProgramError);
}

}  // namespace
}  // namespace atlaswire::render
