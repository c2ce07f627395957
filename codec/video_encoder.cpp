#include "base/program.h"
#include "codec/annex_b.h"
#include "codec/h264_backend.h"
#include "codec/raw_picture.h"
#include "codec/video.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <utility>

namespace atlaswire::codec {

namespace {

constexpr const char* kSoftware = "libx264";
constexpr const char* kRaw = "raw";
constexpr std::array kPresets{"ultrafast", "superfast", "veryfast", "faster",   "fast",
                              "medium",    "slow",      "slower",   "veryslow", "placebo"};

void check(const VideoEncoderSettings& settings) {
  const Extent2D extent = settings.extent;
  if (extent.width < 16 || extent.height < 16 || extent.width > 8192 || extent.height > 8192 ||
      extent.width % 2 != 0 || extent.height % 2 != 0) {
    throw ProgramError(ExitCode::kUsage, fmt::format("cannot encode {}x{} pictures: both sides must be even "
                                                     "and from 16 to 8192",
                                                     extent.width, extent.height));
  }
  if (!(settings.frame_rate >= 0.1 && settings.frame_rate <= 1000)) {
    throw ProgramError(ExitCode::kUsage, "the encoder's frame rate must lie between 0.1 and 1000 a second");
  }
  // libx264 would complain about this one on stderr by itself.
  if (std::find(kPresets.begin(), kPresets.end(), settings.preset) == kPresets.end()) {
    throw ProgramError(ExitCode::kUsage, fmt::format("'{}' is no preset of x264; choose one of {}",
                                                     settings.preset, fmt::join(kPresets, ", ")));
  }
}

}  // namespace

struct VideoEncoder::Impl {
  VideoEncoderSettings settings;
  std::string name;
  std::unique_ptr<H264Backend> backend;  // null: raw
  ByteBuffer parameter_sets;
  std::int64_t next_index = 0;
  std::uint32_t since_idr = 0;  // pictures since the last IDR, that one included
  bool fresh = true;            // the backend has encoded nothing yet

  void open_best();
  Result<EncodedPicture> encode_h264(const I420View& picture, bool idr);
  bool try_open(const std::string& candidate, spdlog::level::level_enum severity);
  void reopen();
};

bool VideoEncoder::Impl::try_open(const std::string& candidate, spdlog::level::level_enum severity) {
  auto opened = H264Backend::open(candidate, settings);
  if (!opened) {
    spdlog::log(severity, "video encoder {} cannot open: {}", candidate, opened.error().detail);
    return false;
  }
  backend = std::move(*opened);
  name = candidate;
  return true;
}

void VideoEncoder::Impl::open_best() {
  if (settings.encoder == kRaw) {
    name = kRaw;
    return;
  }
  const bool automatic = settings.encoder == "auto";
  if (automatic) {
    // Missing hardware is the ordinary case: no warning.
    if (try_open("h264_nvenc", spdlog::level::debug) || try_open("h264_vaapi", spdlog::level::debug)) return;
  } else if (settings.encoder != kSoftware) {
    if (try_open(settings.encoder, spdlog::level::warn)) return;
    spdlog::info("falling back to video encoder {}", kSoftware);
  }
  if (try_open(kSoftware, spdlog::level::warn)) return;
  throw ProgramError(
      ExitCode::kInternal,
      fmt::format("no H.264 encoder opens for {}x{} pictures at {} bits a second: install a "
                  "libavcodec built with libx264, or change extent or bit rate",
                  settings.extent.width, settings.extent.height, settings.bit_rate.bits_per_second));
}

void VideoEncoder::Impl::reopen() {
  auto opened = H264Backend::open(name, settings);
  if (!opened) {
    spdlog::warn("video encoder {} keeps its bit rate: {}", name, opened.error().detail);
    return;
  }
  backend = std::move(*opened);
  fresh = true;
}

VideoEncoder::VideoEncoder(const VideoEncoderSettings& settings) : impl_(std::make_unique<Impl>()) {
  check(settings);
  impl_->settings = settings;
  impl_->open_best();
  spdlog::debug("video encoder {} opened", impl_->name);
}

VideoEncoder::~VideoEncoder() = default;

bool VideoEncoder::next_is_intra() const {
  const std::uint32_t interval = impl_->settings.intra_interval;
  return impl_->fresh || (interval != 0 && impl_->since_idr >= interval);
}

Result<EncodedPicture> VideoEncoder::encode(const I420View& picture, bool force_intra) {
  Impl& self = *impl_;
  if (picture.extent != self.settings.extent) return VideoError::kWrongExtent;
  const bool idr = force_intra || next_is_intra();
  Result<EncodedPicture> out = EncodedPicture{};
  if (self.backend == nullptr) {
    write_raw_picture(picture, out->bytes);
    out->idr = idr;
  } else {
    out = self.encode_h264(picture, idr);
    if (!out) return out;
  }
  out->index = self.next_index++;
  self.since_idr = out->idr ? 1 : self.since_idr + 1;
  self.fresh = false;
  return out;
}

Result<EncodedPicture> VideoEncoder::Impl::encode_h264(const I420View& picture, bool idr) {
  const Result<const AVPacket*> packet = backend->encode(picture, idr, next_index);
  if (!packet) return packet.error();
  EncodedPicture out;
  const auto* data = reinterpret_cast<const std::byte*>((*packet)->data);
  out.bytes.assign(data, data + (*packet)->size);
  out.idr = contains_idr(out.bytes);
  if (idr && !out.idr) return Error{VideoError::kEncoderFailed, "an IDR picture was refused"};
  if (out.idr) parameter_sets = parameter_sets_of(out.bytes);
  return out;
}

void VideoEncoder::set_bit_rate(BitRate rate) {
  if (rate == impl_->settings.bit_rate) return;
  impl_->settings.bit_rate = rate;
  if (impl_->backend != nullptr && !impl_->backend->set_bit_rate(impl_->settings)) impl_->reopen();
}

const std::string& VideoEncoder::name() const { return impl_->name; }

const ByteBuffer& VideoEncoder::parameter_sets() const { return impl_->parameter_sets; }

}  // namespace atlaswire::codec
