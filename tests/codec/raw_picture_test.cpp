#include "codec/raw_picture.h"

#include "tests/codec/video_support.h"

#include <gtest/gtest.h>

namespace atlaswire::codec {
namespace {

constexpr Extent2D kExtent{32, 18};

TEST(RawPicture, ComesBackUnchangedThroughEncoderAndDecoder) {
  VideoEncoder encoder({.extent = kExtent, .intra_interval = 2, .encoder = "raw"});
  VideoDecoder decoder(kExtent, 1, VideoCoding::kRaw);
  EXPECT_EQ(encoder.name(), "raw");
  for (std::uint32_t i = 0; i < 3; ++i) {
    const TestPicture picture = atlas_picture(kExtent, i);
    encoder.set_bit_rate(BitRate{1'000'000 + i});
    const auto encoded = encoder.encode(picture.view(), false);
    ASSERT_TRUE(encoded);
    EXPECT_EQ(encoded->idr, i != 1);
    const auto decoded = decoder.decode(encoded->bytes);
    ASSERT_TRUE(decoded);
    const I420View back = decoded->view();
    ASSERT_EQ(back.extent, kExtent);
    for (std::uint32_t y = 0; y < kExtent.height; ++y) {
      for (std::uint32_t x = 0; x < kExtent.width; ++x) {
        ASSERT_EQ(back.y[y * back.y_stride + x], picture.y[y * kExtent.width + x]);
      }
    }
    for (std::uint32_t y = 0; y < kExtent.height / 2; ++y) {
      for (std::uint32_t x = 0; x < kExtent.width / 2; ++x) {
        ASSERT_EQ(back.u[y * back.uv_stride + x], picture.u[y * kExtent.width / 2 + x]);
        ASSERT_EQ(back.v[y * back.uv_stride + x], picture.v[y * kExtent.width / 2 + x]);
      }
    }
  }
}

TEST(RawPicture, RefusesWhatIsNotOne) {
  ByteBuffer bytes;
  write_raw_picture(atlas_picture(kExtent, 0).view(), bytes);
  EXPECT_EQ(read_raw_picture(bytes, {16, 16}).error().code, VideoError::kTooLarge);
  bytes.pop_back();
  EXPECT_EQ(read_raw_picture(bytes, kExtent).error().code, VideoError::kCorrupt);
  EXPECT_EQ(read_raw_picture({}, kExtent).error().code, VideoError::kCorrupt);
  bytes[3] = std::byte{31};
  EXPECT_EQ(read_raw_picture(bytes, kExtent).error().code, VideoError::kWrongFormat);
}

}  // namespace
}  // namespace atlaswire::codec
