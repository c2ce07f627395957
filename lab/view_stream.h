#pragma once

#include "codec/video.h"
#include "render/method.h"
#include "server/encoded_frame.h"
#include "server/intra_schedule.h"

#include <map>
#include <memory>
#include <span>
#include <vector>

namespace atlaswire::lab {

/// Ordinary pictures of a scene as a stream, for the warps: what server::AtlasStream is for atlases. The meta
/// channel carries a ViewHeader a frame.
class ViewStream final : public server::FrameMaker {
 public:
  /// `method`: one that draws views ("video"). Throws ProgramError when the encoder cannot be made.
  ViewStream(std::unique_ptr<render::Method> method, codec::VideoEncoderSettings video);

  server::PreparedFrame render(const server::ViewRequest& request) override;
  Result<server::EncodedFrame> encode(server::PreparedFrame prepared) override;

  [[nodiscard]] Extent2D picture_extent() const { return method_->picture_extent(); }
  /// The exact depth of a frame, where the method gives one beside the picture (render::VideoDepth::kFree):
  /// taken out, once. Empty for others. Depths of frames before it are forgotten.
  std::vector<float> take_depth(FrameId frame);

 private:
  std::unique_ptr<render::Method> method_;
  server::IntraSchedule schedule_;
  FrameId next_frame_{};
  codec::VideoEncoder video_;
  std::map<FrameId, std::vector<float>> depths_;
};

}  // namespace atlaswire::lab
