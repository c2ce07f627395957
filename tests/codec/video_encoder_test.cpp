#include "base/program.h"
#include "codec/annex_b.h"
#include "codec/video.h"
#include "tests/codec/video_support.h"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <sstream>

namespace atlaswire::codec {
namespace {

constexpr Extent2D kExtent{256, 192};

VideoEncoderSettings software(BitRate rate = {2'000'000}) {
  VideoEncoderSettings settings;
  settings.extent = kExtent;
  settings.bit_rate = rate;
  settings.intra_interval = 5;  // these pictures hardly change: without I-frames they cannot use the rate
  settings.encoder = "libx264";
  return settings;
}

EncodedPicture encode(VideoEncoder& encoder, std::uint32_t frame, bool force = false) {
  return encoder.encode(atlas_picture(kExtent, frame).view(), force).value();
}

/// Average bits of a picture over `count` pictures from `first` on.
double mean_bits(VideoEncoder& encoder, std::uint32_t first, std::uint32_t count) {
  double bits = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    bits += 8.0 * static_cast<double>(encode(encoder, first + i).bytes.size());
  }
  return bits / count;
}

/// Takes the default logger's lines while it lives.
class LogCapture {
 public:
  LogCapture() : before_(spdlog::default_logger()) {
    auto logger =
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(lines_));
    logger->set_level(spdlog::level::info);
    logger->set_pattern("%l %v");
    spdlog::set_default_logger(logger);
  }
  ~LogCapture() { spdlog::set_default_logger(before_); }
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;
  [[nodiscard]] std::string text() const { return lines_.str(); }

 private:
  std::ostringstream lines_;
  std::shared_ptr<spdlog::logger> before_;
};

TEST(VideoRoundTrip, GivesEachPictureBackAtOnceAndAlike) {
  VideoEncoder encoder(software({4'000'000}));
  VideoDecoder decoder(kExtent);
  for (std::uint32_t frame = 0; frame < 12; ++frame) {
    const TestPicture picture = atlas_picture(kExtent, frame);
    const auto encoded = encoder.encode(picture.view(), false);
    ASSERT_TRUE(encoded) << encoded.error().message();
    EXPECT_EQ(encoded->index, frame);
    const auto decoded = decoder.decode(encoded->bytes);
    ASSERT_TRUE(decoded) << decoded.error().message();
    EXPECT_EQ(decoded->view().extent, kExtent);
    EXPECT_GT(luma_psnr(picture.view(), decoded->view()), 38.0) << "frame " << frame;
    EXPECT_LT(luma_psnr(atlas_picture(kExtent, frame + 16).view(), decoded->view()), 25.0);
  }
}

TEST(VideoRoundTrip, KeepsFullRangeAndChroma) {
  TestPicture picture{kExtent, {}, {}, {}};
  picture.y.assign(kExtent.area(), 255);
  picture.u.assign(kExtent.area() / 4, 16);
  picture.v.assign(kExtent.area() / 4, 240);
  VideoEncoder encoder(software());
  const auto encoded = encoder.encode(picture.view(), false).value();
  const auto decoded = VideoDecoder(kExtent).decode(encoded.bytes).value();
  EXPECT_NEAR(decoded.view().y[1000], 255, 2);
  EXPECT_NEAR(decoded.view().u[500], 16, 2);
  EXPECT_NEAR(decoded.view().v[500], 240, 2);
}

TEST(VideoRoundTrip, TakesAnyStrideAndExtent) {
  constexpr Extent2D kOdd{70, 50};  // no multiple of a macroblock
  const TestPicture tight = atlas_picture(kOdd, 3);
  std::vector<std::uint8_t> wide(std::size_t{101} * kOdd.height, 7);
  for (std::uint32_t row = 0; row < kOdd.height; ++row) {
    std::copy_n(tight.y.data() + std::size_t{row} * kOdd.width, kOdd.width,
                wide.data() + std::size_t{row} * 101);
  }
  I420View view = tight.view();
  view.y = wide.data();
  view.y_stride = 101;
  auto settings = software();
  settings.extent = kOdd;
  VideoEncoder encoder(settings);
  const auto encoded = encoder.encode(view, false).value();
  const auto decoded = VideoDecoder(kOdd).decode(encoded.bytes);
  ASSERT_TRUE(decoded) << decoded.error().message();
  EXPECT_GT(luma_psnr(tight.view(), decoded->view()), 38.0);
}

TEST(VideoEncoder, SendsAnIdrExactlyEveryInterval) {
  for (const std::uint32_t interval : {1U, 3U, 5U}) {
    auto settings = software();
    settings.intra_interval = interval;
    VideoEncoder encoder(settings);
    for (std::uint32_t frame = 0; frame < 16; ++frame) {
      const bool expected = frame % interval == 0;
      EXPECT_EQ(encoder.next_is_intra(), expected);
      EXPECT_EQ(encode(encoder, frame).idr, expected) << "frame " << frame << " of interval " << interval;
    }
  }
}

TEST(VideoEncoder, SendsNoIdrUnaskedAtIntervalZero) {
  auto settings = software();
  settings.intra_interval = 0;
  VideoEncoder encoder(settings);
  EXPECT_TRUE(encode(encoder, 0).idr);
  // Unrelated content each time: a scene-change detector would step in here.
  for (std::uint32_t frame = 1; frame < 40; ++frame) EXPECT_FALSE(encode(encoder, 16 * frame).idr);
}

TEST(VideoEncoder, ForcedIdrRestartsTheInterval) {
  VideoEncoder encoder(software());
  std::vector<bool> idr;
  for (std::uint32_t frame = 0; frame < 14; ++frame) {
    idr.push_back(encode(encoder, frame, frame == 3 || frame == 4).idr);
  }
  EXPECT_EQ(idr, (std::vector<bool>{true, false, false, true, true, false, false, false, false, true, false,
                                    false, false, false}));
}

TEST(VideoEncoder, PutsParameterSetsBeforeEachIdr) {
  VideoEncoder encoder(software());
  EXPECT_TRUE(encoder.parameter_sets().empty());
  for (std::uint32_t frame = 0; frame < 11; ++frame) {
    const EncodedPicture picture = encode(encoder, frame);
    const ByteBuffer sets = parameter_sets_of(picture.bytes);
    EXPECT_EQ(!sets.empty(), picture.idr);
    if (picture.idr) {
      EXPECT_EQ(sets, encoder.parameter_sets());
    }
  }
  AnnexBReader units(encoder.parameter_sets());
  EXPECT_EQ(nal_type(units.next().value()), NalType::kSequenceSet);
  EXPECT_EQ(nal_type(units.next().value()), NalType::kPictureSet);
}

TEST(VideoEncoder, LimitsSliceSize) {
  auto settings = software({8'000'000});
  settings.max_slice_bytes = 1000;
  VideoEncoder encoder(settings);
  const EncodedPicture picture = encode(encoder, 0);
  AnnexBReader units(picture.bytes);
  int slices = 0;
  while (const auto unit = units.next()) {
    if (nal_type(*unit) != NalType::kIdr) continue;
    EXPECT_LE(unit->size(), 1000U);
    ++slices;
  }
  EXPECT_GT(slices, 2);
  EXPECT_TRUE(VideoDecoder(kExtent).decode(picture.bytes));
}

TEST(VideoEncoder, HoldsItsBitRateAndFollowsChanges) {
  VideoEncoder encoder(software({2'000'000}));
  const double frame_rate = VideoEncoderSettings{}.frame_rate;
  mean_bits(encoder, 0, 10);  // settle
  EXPECT_NEAR(mean_bits(encoder, 10, 30) * frame_rate, 2e6, 0.25 * 2e6);
  mean_bits(encoder, 40, 2);
  encoder.set_bit_rate({500'000});
  EXPECT_FALSE(encoder.next_is_intra());  // in the middle of an interval, without reopening
  mean_bits(encoder, 42, 18);
  EXPECT_NEAR(mean_bits(encoder, 60, 30) * frame_rate, 5e5, 0.25 * 5e5);
  encoder.set_bit_rate({3'000'000});
  mean_bits(encoder, 90, 20);
  EXPECT_GT(mean_bits(encoder, 110, 30) * frame_rate, 1.5e6);
}

TEST(VideoEncoder, BoundsTheLargestPicture) {
  VideoEncoder encoder(software({1'000'000}));
  for (std::uint32_t frame = 0; frame < 60; ++frame) {
    // Three pictures' worth of the rate is the rate controller's bucket.
    EXPECT_LE(8.0 * static_cast<double>(encode(encoder, 16 * frame).bytes.size()), 1.2 * 3 * 1e6 / 15);
  }
}

TEST(VideoEncoder, ConstantQuantizerWhenNoRateIsSet) {
  auto settings = software({0});
  settings.qp = 20;
  VideoEncoder fine(settings);
  settings.qp = 40;
  VideoEncoder coarse(settings);
  EXPECT_GT(mean_bits(fine, 0, 5), 3 * mean_bits(coarse, 0, 5));
  // Leaving constant quantizer takes a new encoder, which must begin with an IDR.
  fine.set_bit_rate({500'000});
  EXPECT_TRUE(fine.next_is_intra());
  const EncodedPicture next = encode(fine, 5);
  EXPECT_TRUE(next.idr);
  EXPECT_EQ(next.index, 5);
  EXPECT_NEAR((mean_bits(fine, 6, 14), mean_bits(fine, 20, 30)) * 15, 5e5, 0.25 * 5e5);
}

TEST(VideoEncoder, FallsBackFromAnUnknownEncoderWithOneWarning) {
  const LogCapture log;
  auto settings = software();
  settings.encoder = "h264_dreams";
  VideoEncoder encoder(settings);
  EXPECT_EQ(encoder.name(), "libx264");
  EXPECT_NE(log.text().find("warning video encoder h264_dreams cannot open: 'h264_dreams' is no H.264"),
            std::string::npos)
      << log.text();
}

TEST(VideoEncoder, AutoOpensSomethingWithoutWarnings) {
  const LogCapture log;
  auto settings = software();
  settings.encoder = "auto";
  VideoEncoder encoder(settings);
  EXPECT_EQ(log.text(), "");
  EXPECT_TRUE(VideoDecoder(kExtent).decode(encode(encoder, 0).bytes));
}

TEST(VideoEncoder, RefusesImpossibleSettings) {
  auto settings = software();
  settings.extent = {255, 192};
  EXPECT_THROW(VideoEncoder{settings}, ProgramError);
  settings = software();
  settings.preset = "warp-speed";
  EXPECT_THROW(VideoEncoder{settings}, ProgramError);
  settings = software();
  settings.frame_rate = 0;
  EXPECT_THROW(VideoEncoder{settings}, ProgramError);
}

TEST(VideoEncoder, RefusesPicturesOfAnotherExtent) {
  VideoEncoder encoder(software());
  const TestPicture other = atlas_picture({128, 128}, 0);
  const auto result = encoder.encode(other.view(), false);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, VideoError::kWrongExtent);
  EXPECT_EQ(encode(encoder, 0).index, 0);
}

}  // namespace
}  // namespace atlaswire::codec
