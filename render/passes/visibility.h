#pragma once

#include "base/emphasis.h"
#include "render/camera.h"
#include "render/gpu/buffer.h"
#include "render/gpu/descriptors.h"
#include "render/gpu/image.h"
#include "render/gpu/pipeline.h"
#include "render/passes/moved_id_mesh.h"
#include "render/passes/scene_gpu.h"
#include "render/passes/visibility_draws.h"
#include "render/passes/visibility_geometry.h"
#include "render/passes/visibility_occlusion.h"
#include "render/passes/visibility_pipelines.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace atlaswire::render {

/// What visible sets cost and cover.
struct VisibilitySettings {
  double fov_scale = 1.2;       ///< >= 1; room for rotation against larger visible sets
  double id_scale = 1.0;        ///< > 0; id pixels per display pixel along a side
  std::uint32_t max_views = 2;  ///< >= 1; poses a frame
  /// Frames that a patch of at most 32 square pixels stays in the set after it was last seen; steadier sets
  /// against larger ones.
  std::uint32_t hold_frames = 0;
  bool occlusion = true;  ///< drop hidden chunks before their vertices are transformed; same picture
};

/// What one frame's recording amounts to.
struct VisibilityStats {
  std::uint32_t views = 0;
  std::uint32_t chunks_in_view = 0;  ///< inside a view's pyramid, summed over views
  std::uint32_t chunks_tested = 0;   ///< of these, drawn only if the occlusion test lets them; also summed
};

/// The potentially visible set ([SAS] 3.1): id buffers of several poses, each with an enlarged field of view
/// and reversed-Z depth; patches marked in compute, and with them those seen a few frames ago; and for each
/// marked patch the size that it wants in the atlas, seen from the current pose.
///
/// Chunks that showed something in the last frame are drawn first; of the others only those which could show
/// behind what is then there. That drops no visible pixel; but where two surfaces have equal depth, the one
/// that happens to be drawn first shows.
/// Masked surfaces have their holes; blended ones hide nothing and are marked where they pass the depth test.
class VisibilityPass {
 public:
  VisibilityPass(Device& device, const SceneGpu& scene, const VisibilitySettings& settings);

  /// Records one frame: what any of `poses` (1 to max_views of them) sees, sized for `camera`. All that was
  /// recorded before must have finished on the device.
  void record(const vk::raii::CommandBuffer& commands, const Camera& camera, std::span<const Pose> poses);

  /// From the next record() on: priorities add to what surfaces want, and foveation takes from it, 10 degrees
  /// around the view axis excepted ([SAS] 4.3). At first: the scene's own priorities, no foveation. All that
  /// was recorded before must have finished on the device.
  void set_emphasis(const Emphasis& emphasis);

  /// One word a patch (shaders/level_layout.h), after the recorded work has been waited for.
  [[nodiscard]] std::span<const std::uint32_t> levels() const;
  /// The same words, for passes recorded behind this one.
  [[nodiscard]] const Buffer& level_words() const { return geometry_.levels; }
  [[nodiscard]] const VisibilityStats& stats() const { return stats_; }

  /// The last view's id buffer of patches, in use as kSampledInCompute; kNoPatch
  /// where nothing is drawn.
  [[nodiscard]] Image& ids() { return *ids_; }

 private:
  void make_targets(Extent2D extent);
  void find_known_chunks();
  void record_view(const vk::raii::CommandBuffer& commands, const Camera& view, std::uint32_t index);
  void draw(const vk::raii::CommandBuffer& commands, const visibility::ViewConstants& view,
            const DrawList& list, const Buffer& indirect, std::uint32_t first_command, bool clear);
  void clear_results(const vk::raii::CommandBuffer& commands);
  void record_marks(const vk::raii::CommandBuffer& commands);
  void record_hold(const vk::raii::CommandBuffer& commands);
  void record_levels(const vk::raii::CommandBuffer& commands, const Camera& camera);

  Device* device_;
  const SceneGpu* scene_;
  VisibilitySettings settings_;
  VisibilityGeometry geometry_;
  DescriptorLayout layout_;
  DescriptorSets sets_;
  VisibilityPipelines pipelines_;
  vk::raii::Sampler sampler_;
  Buffer commands_;  ///< DrawCommand, a chunk each for every view
  std::optional<ChunkOcclusion> occlusion_;
  std::vector<bool> known_;  ///< by chunk: drawn without a test
  std::unique_ptr<Image> ids_;
  std::unique_ptr<Image> depth_;
  double foveation_ = 0;
  VisibilityStats stats_;
  std::optional<MovedIdMesh> moved_;  ///< of a scene that moves
};

}  // namespace atlaswire::render
