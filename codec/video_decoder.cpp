#include "base/assert.h"
#include "codec/av_support.h"
#include "codec/gap_detector.h"
#include "codec/raw_picture.h"
#include "codec/video.h"

extern "C" {
#include <libavutil/opt.h>
}

#include <algorithm>
#include <limits>
#include <new>
#include <optional>

namespace atlaswire::codec {

struct DecodedPicture::Impl {
  AvFrame frame;
};

DecodedPicture::DecodedPicture() = default;
DecodedPicture::~DecodedPicture() = default;
DecodedPicture::DecodedPicture(DecodedPicture&&) noexcept = default;
DecodedPicture& DecodedPicture::operator=(DecodedPicture&&) noexcept = default;

I420View DecodedPicture::view() const {
  if (!impl_) return {};
  const AVFrame& frame = *impl_->frame;
  return {.extent = {static_cast<std::uint32_t>(frame.width), static_cast<std::uint32_t>(frame.height)},
          .y = frame.data[0],
          .u = frame.data[1],
          .v = frame.data[2],
          .y_stride = static_cast<std::uint32_t>(frame.linesize[0]),
          .uv_stride = static_cast<std::uint32_t>(frame.linesize[1])};
}

struct VideoDecoder::Impl {
  AvContext context;
  AvPacket packet;
  GapDetector gaps;
  ByteBuffer padded;  // libav reads past the end
  Extent2D max_extent;
  std::uint32_t threads = 1;
  VideoCoding coding = VideoCoding::kH264;
  std::optional<VideoError> refusal;  // why get_format refused, if it did

  void open();

  static AVPixelFormat choose_format(AVCodecContext* context, const AVPixelFormat* offered);
  Result<AvFrame> decode_h264(ByteView access_unit);
  Result<AvFrame> receive_last();
  Result<AvFrame> give_up(VideoError why);
};

/// Called when a sequence parameter set takes effect, before anything of the picture's size is allocated.
AVPixelFormat VideoDecoder::Impl::choose_format(AVCodecContext* context, const AVPixelFormat* offered) {
  auto& self = *static_cast<Impl*>(context->opaque);
  const auto macroblocks = [](std::uint32_t side) { return (std::uint64_t{side} + 15) / 16; };
  const auto fits = [&](int coded, std::uint32_t limit) {
    return coded > 0 && static_cast<std::uint64_t>(coded) <= 16 * macroblocks(limit);
  };
  if (!fits(context->coded_width, self.max_extent.width) ||
      !fits(context->coded_height, self.max_extent.height)) {
    self.refusal = VideoError::kTooLarge;
    return AV_PIX_FMT_NONE;
  }
  for (; *offered != AV_PIX_FMT_NONE; ++offered) {
    if (*offered == AV_PIX_FMT_YUV420P || *offered == AV_PIX_FMT_YUVJ420P) return *offered;
  }
  self.refusal = VideoError::kWrongFormat;
  return AV_PIX_FMT_NONE;
}

void VideoDecoder::Impl::open() {
  const AVCodec* codec = avcodec_find_decoder(AV_CODEC_ID_H264);
  AW_ASSERT(codec != nullptr);  // every libavcodec we build against has it
  context.reset(avcodec_alloc_context3(codec));
  if (!context) throw std::bad_alloc();
  context->opaque = this;
  context->get_format = &Impl::choose_format;
  context->flags |= AV_CODEC_FLAG_LOW_DELAY;
  context->thread_type = FF_THREAD_SLICE;
  context->thread_count = static_cast<int>(threads);
  context->err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER | AV_EF_EXPLODE;
  // Concealment is what counts the macroblocks that no slice brought; what it concealed is refused below.
  // libavcodec leaves it off for slice threads unless told.
  av_opt_set(context->priv_data, "enable_er", "1", 0);
  const int code = avcodec_open2(context.get(), codec, nullptr);
  AW_ASSERT(code >= 0);
}

VideoDecoder::VideoDecoder(Extent2D max_extent, std::uint32_t threads, VideoCoding coding)
    : impl_(std::make_unique<Impl>()) {
  route_av_log();
  impl_->max_extent = max_extent;
  impl_->threads = std::clamp(threads, 1U, 16U);
  impl_->coding = coding;
  impl_->packet.reset(av_packet_alloc());
  if (!impl_->packet) throw std::bad_alloc();
  impl_->open();
}

VideoDecoder::~VideoDecoder() = default;

/// Starts anew: flushing alone would keep what a corrupt parameter set said about reordering.
Result<AvFrame> VideoDecoder::Impl::give_up(VideoError why) {
  open();
  gaps.reset();
  return refusal.value_or(why);
}

Result<AvFrame> VideoDecoder::Impl::receive_last() {
  AvFrame last;
  for (;;) {
    AvFrame frame(av_frame_alloc());
    if (!frame) throw std::bad_alloc();
    const int code = avcodec_receive_frame(context.get(), frame.get());
    if (code == AVERROR(EAGAIN)) break;
    if (code < 0) return give_up(VideoError::kCorrupt);
    if (frame->decode_error_flags != 0 || (frame->flags & AV_FRAME_FLAG_CORRUPT) != 0) {
      return give_up(VideoError::kCorrupt);
    }
    last = std::move(frame);
  }
  if (context->has_b_frames > 0) return give_up(VideoError::kWrongFormat);
  if (!last) return give_up(VideoError::kNoPicture);
  return last;
}

Result<AvFrame> VideoDecoder::Impl::decode_h264(ByteView access_unit) {
  if (access_unit.empty()) return VideoError::kNoPicture;
  if (access_unit.size() > std::numeric_limits<int>::max() / 2) return VideoError::kTooLarge;
  refusal.reset();
  const GapDetector::Verdict verdict = gaps.inspect(access_unit);
  if (verdict == GapDetector::Verdict::kNoReference) return VideoError::kNoPicture;
  if (verdict == GapDetector::Verdict::kGap) return give_up(VideoError::kCorrupt).error();
  padded.assign(access_unit.begin(), access_unit.end());
  padded.resize(access_unit.size() + AV_INPUT_BUFFER_PADDING_SIZE);
  packet->data = reinterpret_cast<std::uint8_t*>(padded.data());
  packet->size = static_cast<int>(access_unit.size());
  const int code = avcodec_send_packet(context.get(), packet.get());
  return code < 0 ? give_up(VideoError::kCorrupt) : receive_last();
}

Result<DecodedPicture> VideoDecoder::decode(ByteView access_unit) {
  Impl& self = *impl_;
  Result<AvFrame> frame = self.coding == VideoCoding::kRaw ? read_raw_picture(access_unit, self.max_extent)
                                                           : self.decode_h264(access_unit);
  if (!frame) return frame.error();
  const AVFrame& f = **frame;
  const bool planar = (f.format == AV_PIX_FMT_YUV420P || f.format == AV_PIX_FMT_YUVJ420P) &&
                      f.linesize[0] > 0 && f.linesize[1] > 0 && f.linesize[1] == f.linesize[2];
  if (!planar || f.width % 2 != 0 || f.height % 2 != 0) return VideoError::kWrongFormat;
  if (static_cast<std::uint32_t>(f.width) > self.max_extent.width ||
      static_cast<std::uint32_t>(f.height) > self.max_extent.height) {
    return VideoError::kTooLarge;
  }
  DecodedPicture picture;
  picture.impl_ = std::make_unique<DecodedPicture::Impl>();
  picture.impl_->frame = std::move(*frame);
  return picture;
}

const char* error_text(VideoError e) {
  switch (e) {
    case VideoError::kEncoderFailed:
      return "the video encoder failed";
    case VideoError::kCorrupt:
      return "the picture's bytes are corrupt or incomplete";
    case VideoError::kNoPicture:
      return "the bytes hold no picture that can be shown yet";
    case VideoError::kTooLarge:
      return "the picture is larger than agreed";
    case VideoError::kWrongFormat:
      return "the picture is not 8-bit 4:2:0 with even sides";
    case VideoError::kWrongExtent:
      return "the picture's extent is not the encoder's";
  }
  return "unknown video error";
}

}  // namespace atlaswire::codec
