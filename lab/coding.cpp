#include "lab/coding.h"

#include <cmath>

namespace atlaswire::lab {

codec::VideoCoding video_coding(const PointSettings& settings) {
  const bool bare = settings.bitrate_mbps <= 0 && settings.qp < 0;
  return bare ? codec::VideoCoding::kRaw : codec::VideoCoding::kH264;
}

codec::VideoEncoderSettings video_settings(const PointSettings& settings) {
  codec::VideoEncoderSettings video;
  video.frame_rate = settings.server_hz;
  video.preset = settings.preset;
  video.intra_interval = settings.intra_interval;
  video.threads = 1;  // x264's rate control of parallel slices depends on which is done first
  video.encoder = video_coding(settings) == codec::VideoCoding::kRaw ? "raw" : "libx264";
  if (settings.qp >= 0) {
    video.bit_rate = {};
    video.qp = settings.qp;
  } else {
    video.bit_rate = {static_cast<std::uint64_t>(std::llround(settings.bitrate_mbps * 1e6))};
  }
  return video;
}

}  // namespace atlaswire::lab
