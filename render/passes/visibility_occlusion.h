#pragma once

#include "render/gpu/descriptors.h"
#include "render/gpu/pipeline.h"
#include "render/passes/visibility_draws.h"
#include "shaders/visibility_layout.h"

#include <cstdint>
#include <optional>

namespace atlaswire::render {

/// Tests chunks against the depth of what is drawn already, on the device, and leaves indirect commands that
/// draw only those which could still show. Conservative: dropping a chunk never changes a pixel.
class ChunkOcclusion {
 public:
  /// `capacity`: candidates of all views of a frame together.
  ChunkOcclusion(const Device& device, std::uint32_t capacity);

  /// What to test against from now on; nothing recorded may be pending.
  void set_depth(const Image& depth);

  /// Tests `list`, placed at `first` in commands(); leaves `depth` in use as kSampledInCompute and the
  /// commands ready to draw.
  void record(const vk::raii::CommandBuffer& commands, Image& depth, const visibility::ViewConstants& view,
              const DrawList& list, std::uint32_t first);

  /// DrawCommand by candidate.
  [[nodiscard]] const Buffer& commands() const { return commands_; }

 private:
  const Device* device_;
  DescriptorLayout layout_;
  DescriptorSets sets_;
  Pipeline grid_pipeline_;
  Pipeline cull_pipeline_;
  vk::raii::Sampler sampler_;
  Buffer candidates_;
  Buffer commands_;
  std::optional<Buffer> grid_;
};

}  // namespace atlaswire::render
