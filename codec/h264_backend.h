#pragma once

#include "base/result.h"
#include "codec/av_support.h"
#include "codec/video.h"

#include <memory>
#include <string>

namespace atlaswire::codec {

/// One opened libavcodec H.264 encoder. Zero delay: a picture in, its packet out.
class H264Backend {
 public:
  /// Opens libavcodec's encoder `name` with the settings; an Error names the reason.
  static Result<std::unique_ptr<H264Backend>> open(const std::string& name,
                                                   const VideoEncoderSettings& settings);

  /// Encodes the borrowed picture, of the settings' extent, as an IDR if asked. The packet's data live
  /// until the next call.
  Result<const AVPacket*> encode(const I420View& picture, bool idr, std::int64_t index);

  /// Takes a new rate without reopening; false if this encoder cannot.
  bool set_bit_rate(const VideoEncoderSettings& settings);

 private:
  H264Backend() = default;
  Result<void> open_vaapi_frames(const VideoEncoderSettings& settings);
  int lend(const I420View& picture);
  int upload(const I420View& picture);

  AvContext context_;
  AvPacket packet_;
  AvFrame frame_;
  AvBuffer device_;  // VA-API's, null for the others
  AvFrame staging_;  // NV12 on its way to a VA-API surface
};

/// Size of the rate controller's leaky bucket in bits: 0.6 of an intra interval, 1 to 3 pictures. Small
/// enough that no IDR takes longer than that to send at the bit rate, large enough that IDRs do not starve.
std::int64_t vbv_bits(const VideoEncoderSettings& settings);

}  // namespace atlaswire::codec
