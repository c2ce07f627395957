#pragma once

#include "codec/video.h"
#include "lab/point.h"

namespace atlaswire::lab {

/// The video encoder that a point asks for; its extent follows the method's picture.
codec::VideoEncoderSettings video_settings(const PointSettings& settings);
/// How its pictures travel.
codec::VideoCoding video_coding(const PointSettings& settings);

}  // namespace atlaswire::lab
