#pragma once

#include "render/gpu/gpu_timer.h"
#include "render/gpu/offscreen_target.h"
#include "render/gpu/submit_context.h"
#include "render/method.h"
#include "render/passes/forward.h"
#include "render/passes/i420_pass.h"
#include "render/passes/scene_gpu.h"

#include <memory>
#include <optional>
#include <vector>

namespace atlaswire::render {

/// Conventional streaming ([SAS] 5.6): the scene drawn for the request's camera with the ground truth's
/// materials, as ordinary pictures for a client that warps them (render/warp/view_warp.h). The view is
/// enlarged by MethodSettings::fov_scale, and some pixels more so that its width is a multiple of 8; as many
/// on one side as on the other, so that the pixels in its middle are exactly the display's.
///
/// Nothing is predicted: FrameRequest's `cover` and `hints` do not apply. There is no atlas, so frames have
/// `view` instead of `change`; their layout, usage and bias stay at their defaults, and `shaded_texels` is
/// the pixels of the view, once each. Each render() waits for its one submission.
class VideoMethod final : public Method {
 public:
  /// Throws ProgramError for odd sides of the display or a scale outside [1, 4].
  VideoMethod(Device& device, std::shared_ptr<const Scene> scene, const MethodSettings& settings);

  [[nodiscard]] Extent2D picture_extent() const override { return conversion_.picture_extent(); }
  /// The request's camera has the extent VideoSettings::display.
  RenderedFrame render(const FrameRequest& request) override;
  void set_emphasis(const Emphasis& /*emphasis*/) override {}
  [[nodiscard]] bool wants_intra() const override { return false; }
  [[nodiscard]] std::optional<AllocatorSettings> memory() const override { return std::nullopt; }
  [[nodiscard]] std::vector<PlacedPatch> blocks() const override { return {}; }

 private:
  void draw(const Camera& view, std::uint32_t slot, RenderTimings& timings);
  void read_depth(const Camera& view, std::vector<float>& depth) const;

  MethodSettings settings_;
  SceneGpu scene_gpu_;
  ForwardPass forward_;
  OffscreenTarget target_;
  I420Pass conversion_;
  std::optional<Buffer> depth_;             ///< the target's, unless VideoDepth::kNone
  std::vector<std::vector<float>> depths_;  ///< distances by slot
  GpuTimer timer_;
  SubmitContext context_;
  std::uint32_t frames_ = 0;  ///< rendered so far; wraps
};

}  // namespace atlaswire::render
