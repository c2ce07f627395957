#include "codec/h264_backend.h"

extern "C" {
#include <libavutil/hwcontext.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <cmath>
#include <limits>

namespace atlaswire::codec {

namespace {

constexpr std::int64_t kMinBitRate = 32'000;  // libx264 counts whole kbit/s; below this nothing is legible

std::int64_t bits_per_second(const VideoEncoderSettings& settings) {
  const auto limit = static_cast<std::uint64_t>(std::numeric_limits<int>::max());
  return std::max(kMinBitRate, static_cast<std::int64_t>(std::min(settings.bit_rate.bits_per_second, limit)));
}

/// A little above the mean: x264 held to the mean itself forgets at once what a quiet picture left over, and
/// a short buffer then leaves a tenth of the rate unused.
constexpr double kPeak = 1.2;

void set_rate(AVCodecContext& context, const VideoEncoderSettings& settings) {
  if (settings.bit_rate.bits_per_second == 0) return;
  context.bit_rate = bits_per_second(settings);
  context.rc_max_rate = static_cast<std::int64_t>(kPeak * static_cast<double>(context.bit_rate));
  context.rc_buffer_size = static_cast<int>(vbv_bits(settings));
}

void set_common(AVCodecContext& context, const VideoEncoderSettings& settings) {
  context.width = static_cast<int>(settings.extent.width);
  context.height = static_cast<int>(settings.extent.height);
  context.pix_fmt = AV_PIX_FMT_YUV420P;
  context.color_range = AVCOL_RANGE_JPEG;
  context.colorspace = AVCOL_SPC_BT709;
  context.color_primaries = AVCOL_PRI_BT709;
  context.color_trc = AVCOL_TRC_BT709;
  context.framerate = av_d2q(settings.frame_rate, 100'000);
  context.time_base = av_inv_q(context.framerate);
  // IDRs are forced one by one, so that the interval is exact; this only tells rate control.
  context.gop_size = settings.intra_interval == 0 ? std::numeric_limits<int>::max() / 2
                                                  : static_cast<int>(settings.intra_interval);
  context.max_b_frames = 0;
  context.refs = 1;
  context.flags |= AV_CODEC_FLAG_LOW_DELAY | AV_CODEC_FLAG_CLOSED_GOP;
  context.thread_count = static_cast<int>(std::clamp(settings.threads, 1U, 16U));
  context.thread_type = FF_THREAD_SLICE;
  set_rate(context, settings);
}

void set(AVCodecContext& context, const char* option, const std::string& setting) {
  av_opt_set(context.priv_data, option, setting.c_str(), 0);
}

/// Private options: unknown ones are left out by libav with an error code that does not matter here.
void set_private(AVCodecContext& context, const std::string& name, const VideoEncoderSettings& settings) {
  set(context, "forced-idr", "1");
  set(context, "aud", "0");
  const bool constant = settings.bit_rate.bits_per_second == 0;
  const std::string qp = std::to_string(std::clamp(settings.qp, 0, 51));
  if (name == "libx264") {
    set(context, "preset", settings.preset);
    set(context, "tune", "zerolatency");
    set(context, "coder", "cavlc");
    set(context, "sc_threshold", "0");
    if (constant) set(context, "qp", qp);
    if (settings.max_slice_bytes != 0)
      set(context, "slice-max-size", std::to_string(settings.max_slice_bytes));
  } else if (name == "h264_nvenc") {
    set(context, "preset", "p2");
    set(context, "tune", "ull");
    set(context, "zerolatency", "1");
    set(context, "delay", "0");
    set(context, "coder", "cavlc");
    set(context, "rc", constant ? "constqp" : "cbr");
    if (constant) set(context, "qp", qp);
    if (settings.max_slice_bytes != 0)
      set(context, "max_slice_size", std::to_string(settings.max_slice_bytes));
  } else if (name == "h264_vaapi") {
    set(context, "async_depth", "1");
    set(context, "coder", "cavlc");
    set(context, "rc_mode", constant ? "CQP" : "CBR");
    if (constant) set(context, "qp", qp);
  }
}

std::string reason(int code) {
  const std::string complaint = av_complaint();
  return complaint.empty() ? av_error_text(code) : complaint;
}

void no_free(void*, std::uint8_t*) {}  // the planes are borrowed

}  // namespace

std::int64_t vbv_bits(const VideoEncoderSettings& settings) {
  const double frames = settings.intra_interval == 0
                            ? 3.0
                            : std::clamp(0.6 * static_cast<double>(settings.intra_interval), 1.0, 3.0);
  const double bits = frames * static_cast<double>(bits_per_second(settings)) / settings.frame_rate;
  return static_cast<std::int64_t>(std::min(bits, 2e9));
}

Result<std::unique_ptr<H264Backend>> H264Backend::open(const std::string& name,
                                                       const VideoEncoderSettings& settings) {
  route_av_log();
  clear_av_complaint();
  const AVCodec* codec = avcodec_find_encoder_by_name(name.c_str());
  if (codec == nullptr || codec->id != AV_CODEC_ID_H264) {
    return Error{VideoError::kEncoderFailed, "'" + name + "' is no H.264 encoder of this libavcodec"};
  }
  std::unique_ptr<H264Backend> backend(new H264Backend);
  backend->context_.reset(avcodec_alloc_context3(codec));
  backend->packet_.reset(av_packet_alloc());
  backend->frame_.reset(av_frame_alloc());
  if (!backend->context_ || !backend->packet_ || !backend->frame_) throw std::bad_alloc();
  set_common(*backend->context_, settings);
  set_private(*backend->context_, name, settings);
  if (name == "h264_vaapi") {
    if (const auto ready = backend->open_vaapi_frames(settings); !ready) return ready.error();
  }
  const int code = avcodec_open2(backend->context_.get(), codec, nullptr);
  if (code < 0) return Error{VideoError::kEncoderFailed, reason(code)};
  return backend;
}

Result<void> H264Backend::open_vaapi_frames(const VideoEncoderSettings& settings) {
  AVBufferRef* device = nullptr;
  int code = av_hwdevice_ctx_create(&device, AV_HWDEVICE_TYPE_VAAPI, nullptr, nullptr, 0);
  if (code < 0) return Error{VideoError::kEncoderFailed, reason(code)};
  device_.reset(device);
  AvBuffer frames(av_hwframe_ctx_alloc(device));
  staging_.reset(av_frame_alloc());
  if (!frames || !staging_) throw std::bad_alloc();
  auto& pool = *reinterpret_cast<AVHWFramesContext*>(frames->data);
  pool.format = AV_PIX_FMT_VAAPI;
  pool.sw_format = AV_PIX_FMT_NV12;
  pool.width = static_cast<int>(settings.extent.width);
  pool.height = static_cast<int>(settings.extent.height);
  pool.initial_pool_size = 4;
  if (code = av_hwframe_ctx_init(frames.get()); code < 0) {
    return Error{VideoError::kEncoderFailed, reason(code)};
  }
  staging_->format = AV_PIX_FMT_NV12;
  staging_->width = pool.width;
  staging_->height = pool.height;
  if (code = av_frame_get_buffer(staging_.get(), 0); code < 0) {
    return Error{VideoError::kEncoderFailed, reason(code)};
  }
  context_->pix_fmt = AV_PIX_FMT_VAAPI;
  context_->hw_frames_ctx = frames.release();
  return {};
}

int H264Backend::lend(const I420View& picture) {
  // A buffer that frees nothing makes the frame count as referenced, so libavcodec does not copy it. Every
  // encoder we open copies the planes into its own memory before its call returns.
  AVFrame& frame = *frame_;
  auto* y = const_cast<std::uint8_t*>(picture.y);
  frame.buf[0] = av_buffer_create(y, std::size_t{picture.y_stride} * picture.extent.height, no_free, nullptr,
                                  AV_BUFFER_FLAG_READONLY);
  if (frame.buf[0] == nullptr) return AVERROR(ENOMEM);
  frame.data[0] = y;
  frame.data[1] = const_cast<std::uint8_t*>(picture.u);
  frame.data[2] = const_cast<std::uint8_t*>(picture.v);
  frame.linesize[0] = static_cast<int>(picture.y_stride);
  frame.linesize[1] = static_cast<int>(picture.uv_stride);
  frame.linesize[2] = frame.linesize[1];
  frame.format = AV_PIX_FMT_YUV420P;
  return 0;
}

int H264Backend::upload(const I420View& picture) {
  const Extent2D half{picture.extent.width / 2, picture.extent.height / 2};
  for (std::uint32_t row = 0; row < picture.extent.height; ++row) {
    std::copy_n(picture.y + std::size_t{row} * picture.y_stride, picture.extent.width,
                staging_->data[0] + std::ptrdiff_t{row} * staging_->linesize[0]);
  }
  for (std::uint32_t row = 0; row < half.height; ++row) {
    std::uint8_t* uv = staging_->data[1] + std::ptrdiff_t{row} * staging_->linesize[1];
    const std::size_t start = std::size_t{row} * picture.uv_stride;
    for (std::uint32_t column = 0; column < half.width; ++column) {
      uv[2 * column] = picture.u[start + column];
      uv[2 * column + 1] = picture.v[start + column];
    }
  }
  const int code = av_hwframe_get_buffer(context_->hw_frames_ctx, frame_.get(), 0);
  return code < 0 ? code : av_hwframe_transfer_data(frame_.get(), staging_.get(), 0);
}

Result<const AVPacket*> H264Backend::encode(const I420View& picture, bool idr, std::int64_t index) {
  clear_av_complaint();
  av_packet_unref(packet_.get());
  av_frame_unref(frame_.get());
  int code = device_ ? upload(picture) : lend(picture);
  AVFrame& frame = *frame_;
  frame.width = static_cast<int>(picture.extent.width);
  frame.height = static_cast<int>(picture.extent.height);
  frame.color_range = AVCOL_RANGE_JPEG;
  frame.colorspace = AVCOL_SPC_BT709;
  frame.pts = index;
  frame.pict_type = idr ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
  if (code >= 0) code = avcodec_send_frame(context_.get(), &frame);
  if (code >= 0) code = avcodec_receive_packet(context_.get(), packet_.get());
  av_frame_unref(&frame);
  if (code < 0) return Error{VideoError::kEncoderFailed, reason(code)};
  return static_cast<const AVPacket*>(packet_.get());
}

bool H264Backend::set_bit_rate(const VideoEncoderSettings& settings) {
  // libx264 and nvenc compare these fields with their own at each picture and reconfigure themselves, but
  // neither changes between constant quantizer and a rate; VA-API looks only when it opens.
  const bool constant = settings.bit_rate.bits_per_second == 0;
  if (device_ || constant != (context_->bit_rate == 0 || context_->rc_max_rate == 0)) return false;
  set_rate(*context_, settings);
  return true;
}

}  // namespace atlaswire::codec
