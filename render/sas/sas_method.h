#pragma once

#include "render/gpu/gpu_timer.h"
#include "render/gpu/submit_context.h"
#include "render/method.h"
#include "render/passes/i420_pass.h"
#include "render/passes/scene_gpu.h"
#include "render/passes/shading.h"
#include "render/passes/visibility.h"
#include "render/sas/freed_texels.h"
#include "render/sas/layout_planner.h"

#include <memory>
#include <vector>

namespace atlaswire::render {

/// Shading atlas streaming ([SAS] 3): visible set, levels, atlas memory, shading into a persistent atlas,
/// I420. Each render() waits for its two submissions: one that ends with the levels' read-back, one that ends
/// with the picture. Equal requests in equal order give equal bytes on one device.
///
/// Blocks that are new or moved, and those of what moves in the scene, are shaded at once, the others every
/// MethodSettings::reshade_interval-th frame, chunk by chunk in rotation. On intra frames texels that no
/// patch holds any more are cleared to mid-grey of coverage 0 ([SAS] 4.2), and the allocator may reset.
class SasMethod final : public Method {
 public:
  SasMethod(Device& device, std::shared_ptr<const Scene> scene, const MethodSettings& settings);

  [[nodiscard]] Extent2D picture_extent() const override { return conversion_.picture_extent(); }
  RenderedFrame render(const FrameRequest& request) override;
  void set_emphasis(const Emphasis& emphasis) override { visibility_.set_emphasis(emphasis); }
  [[nodiscard]] bool wants_intra() const override {
    return reset_is_urgent(planner_->allocator(), settings_.atlas);
  }
  [[nodiscard]] std::optional<AllocatorSettings> memory() const override {
    return settings_.strategy == Strategy::kS0 ? std::optional(settings_.allocator) : std::nullopt;
  }
  [[nodiscard]] std::vector<PlacedPatch> blocks() const override { return planner_->allocator().blocks(); }

  /// What the last frame's visibility pass did.
  [[nodiscard]] const VisibilityStats& visibility_stats() const { return visibility_.stats(); }
  /// The last frame's level words, one a patch.
  [[nodiscard]] std::span<const std::uint32_t> levels() const { return visibility_.levels(); }

 private:
  void find_visible(const FrameRequest& request);
  void choose_stale(const LayoutChange& change);
  std::vector<Mover> take_moved();
  void clear_freed(const vk::raii::CommandBuffer& commands);
  std::uint64_t shade(const FrameRequest& request, std::uint32_t slot, RenderTimings& timings);

  MethodSettings settings_;
  std::shared_ptr<const Scene> scene_;
  SceneGpu scene_gpu_;
  VisibilityPass visibility_;
  std::unique_ptr<LayoutPlanner> planner_;
  FreedTexels freed_;
  ShadingPass shading_;
  I420Pass conversion_;
  GpuTimer timer_;
  SubmitContext context_;
  std::vector<std::uint32_t> chunk_of_patch_;
  std::vector<PlacedPatch> stale_;              ///< what this frame shades, ascending
  std::vector<std::uint64_t> shaded_versions_;  ///< by part of the scene that moves
  std::uint32_t frames_ = 0;                    ///< rendered so far; wraps
};

}  // namespace atlaswire::render
