#include "base/random.h"
#include "codec/annex_b.h"
#include "codec/video.h"
#include "tests/codec/video_support.h"

#include <gtest/gtest.h>

namespace atlaswire::codec {
namespace {

constexpr Extent2D kExtent{256, 192};

/// `count` pictures of one stream, the first an IDR; `interval` pictures from IDR to IDR.
std::vector<ByteBuffer> stream(std::uint32_t count, std::uint32_t interval = 5, Extent2D extent = kExtent,
                               const char* preset = "ultrafast") {
  VideoEncoderSettings settings;
  settings.extent = extent;
  settings.bit_rate = {2'000'000};
  settings.encoder = "libx264";
  settings.preset = preset;
  settings.intra_interval = interval;
  VideoEncoder encoder(settings);
  std::vector<ByteBuffer> out;
  for (std::uint32_t frame = 0; frame < count; ++frame) {
    out.push_back(encoder.encode(atlas_picture(extent, frame).view(), false).value().bytes);
  }
  return out;
}

std::error_code refusal(VideoDecoder& decoder, ByteView bytes) {
  const auto result = decoder.decode(bytes);
  return result ? std::error_code{} : result.error().code;
}

class VideoDecoderThreads : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Threads, VideoDecoderThreads, testing::Values(1U, 2U));

TEST_P(VideoDecoderThreads, MissingSliceIsCorrupt) {
  const auto pictures = stream(2);
  for (const ByteBuffer& whole : pictures) {
    ByteBuffer cut;
    int slices = 0;
    AnnexBReader units(whole);
    while (const auto unit = units.next()) {
      const bool slice = nal_type(*unit) == NalType::kIdr || nal_type(*unit) == NalType::kSlice;
      if (slice && slices++ == 1) continue;
      for (const int octet : {0, 0, 1}) cut.push_back(static_cast<std::byte>(octet));
      cut.insert(cut.end(), unit->begin(), unit->end());
    }
    ASSERT_EQ(slices, 2);
    VideoDecoder decoder(kExtent, GetParam());
    if (&whole != &pictures[0]) {
      ASSERT_FALSE(refusal(decoder, pictures[0]));
    }
    EXPECT_EQ(refusal(decoder, cut), VideoError::kCorrupt);
  }
}

TEST_P(VideoDecoderThreads, TruncatedPictureIsRefused) {
  const auto pictures = stream(1);
  VideoDecoder decoder(kExtent, GetParam());
  for (const std::size_t keep : {1U, 5U, 20U, 200U, 900U}) {
    EXPECT_TRUE(refusal(decoder, ByteView(pictures[0]).first(keep))) << keep;
  }
  EXPECT_TRUE(refusal(decoder, ByteView(pictures[0]).first(pictures[0].size() - 100)));
  EXPECT_FALSE(refusal(decoder, pictures[0]));
}

TEST_P(VideoDecoderThreads, SurvivesRandomCorruptionAndRecoversAtTheNextIdr) {
  const auto pictures = stream(5);
  Random random(17 + GetParam());
  VideoDecoder decoder(kExtent, GetParam());
  int refused = 0;
  for (int round = 0; round < 150; ++round) {
    for (ByteBuffer bent : pictures) {
      for (std::uint64_t hits = 1 + random.below(6); hits > 0; --hits) {
        bent[random.below(bent.size())] = static_cast<std::byte>(random.below(256));
      }
      const auto result = decoder.decode(bent);
      refused += result ? 0 : 1;
      if (result) {
        EXPECT_EQ(result->view().extent, kExtent);
      }
    }
    const auto whole = decoder.decode(pictures[0]);
    ASSERT_TRUE(whole) << "round " << round << ": " << whole.error().message();
    ASSERT_GT(luma_psnr(atlas_picture(kExtent, 0).view(), whole->view()), 30.0) << "round " << round;
  }
  EXPECT_GT(refused, 400);  // of 750
}

TEST(VideoDecoder, RefusesLargerPicturesThanAgreed) {
  const auto pictures = stream(1, 5, {512, 256});
  VideoDecoder narrow({496, 256});
  EXPECT_EQ(refusal(narrow, pictures[0]), VideoError::kTooLarge);
  VideoDecoder low({512, 254});
  EXPECT_EQ(refusal(low, pictures[0]), VideoError::kTooLarge);
  VideoDecoder enough({512, 256});
  EXPECT_FALSE(refusal(enough, pictures[0]));
}

TEST(VideoDecoder, GoesOnAfterRefusingALargePicture) {
  VideoDecoder decoder(kExtent);
  EXPECT_EQ(refusal(decoder, stream(1, 5, {512, 256})[0]), VideoError::kTooLarge);
  EXPECT_FALSE(refusal(decoder, stream(1)[0]));
}

TEST(VideoDecoder, GivesNoPictureBeforeAnIdr) {
  const auto pictures = stream(7);
  VideoDecoder decoder(kExtent);
  for (std::size_t i = 1; i < 5; ++i) EXPECT_TRUE(refusal(decoder, pictures[i])) << i;
  EXPECT_FALSE(refusal(decoder, pictures[5]));
  EXPECT_FALSE(refusal(decoder, pictures[6]));
}

TEST_P(VideoDecoderThreads, PictureAfterALostOneIsRefused) {
  const auto pictures = stream(5, 5, kExtent, GetParam() == 1 ? "ultrafast" : "superfast");
  VideoDecoder decoder(kExtent, GetParam());
  ASSERT_FALSE(refusal(decoder, pictures[0]));
  ASSERT_FALSE(refusal(decoder, pictures[1]));
  EXPECT_EQ(refusal(decoder, pictures[3]), VideoError::kCorrupt);
  EXPECT_EQ(refusal(decoder, pictures[4]), VideoError::kNoPicture);
}

TEST(VideoDecoder, FollowsLongIntervalsAcrossWraps) {
  for (const char* preset : {"ultrafast", "superfast", "medium"}) {  // baseline and high profile
    VideoDecoder decoder(kExtent);
    for (const ByteBuffer& picture : stream(140, 0, kExtent, preset)) EXPECT_FALSE(refusal(decoder, picture));
  }
}

TEST(VideoDecoder, RefusesBytesThatAreNoVideo) {
  VideoDecoder decoder(kExtent);
  EXPECT_EQ(refusal(decoder, {}), VideoError::kNoPicture);
  Random random(23);
  for (int round = 0; round < 200; ++round) {
    ByteBuffer noise(1 + random.below(3000));
    for (std::byte& octet : noise) octet = static_cast<std::byte>(random.below(256));
    EXPECT_TRUE(refusal(decoder, noise));
  }
  EXPECT_FALSE(refusal(decoder, stream(1)[0]));
}

TEST(VideoDecoder, PictureOutlivesItsDecoder) {
  DecodedPicture picture;
  EXPECT_EQ(picture.view().y, nullptr);
  {
    VideoDecoder decoder(kExtent);
    picture = decoder.decode(stream(1)[0]).value();
  }
  EXPECT_GT(luma_psnr(atlas_picture(kExtent, 0).view(), picture.view()), 30.0);
}

}  // namespace
}  // namespace atlaswire::codec
