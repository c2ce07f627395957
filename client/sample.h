#pragma once

#include "base/ids.h"
#include "base/time.h"
#include "codec/video.h"
#include "render/camera.h"
#include "render/image/picture.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace atlaswire::client {

/// A displayed frame kept for the comparison with ground truth.
struct Sample {
  FrameId frame{};
  std::uint64_t display_index = 0;
  render::Camera camera;
  std::optional<Duration> scene_time;  ///< that the truth is of; nullopt: nothing moves
  render::Picture view;
  std::shared_ptr<const codec::DecodedPicture> atlas;
};

/// When samples are due: `count` of them in the middles of equal parts of the measured time.
class SampleSchedule {
 public:
  /// An endless run (`duration` zero) is sampled once a second.
  SampleSchedule(std::uint32_t count, Duration warm_up, Duration duration);
  /// Is a sample due, `since_start` after the run's start? At most one a call, at most `count` in all.
  bool take(Duration since_start);

 private:
  std::uint32_t count_;
  std::uint32_t taken_ = 0;
  Duration first_;
  Duration step_;
};

}  // namespace atlaswire::client
