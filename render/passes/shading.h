#pragma once

#include "render/atlas/allocator.h"
#include "render/gpu/buffer.h"
#include "render/passes/material_pipelines.h"
#include "render/passes/scene_gpu.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

namespace atlaswire::render {

/// Shades patches into their blocks of a persistent atlas ([SAS] 3.2): a geometry pass over the patches'
/// triangles with their atlas places as positions, without depth or culling. Texels hold tone-mapped
/// sRGB-encoded colour, alpha holds coverage. One thread at a time.
class ShadingPass {
 public:
  /// `frames_in_flight`: recordings that may be pending at once.
  ShadingPass(Device& device, const SceneGpu& scene, Extent2D atlas, std::uint32_t frames_in_flight);

  /// Shades `patches` (ascending, blocks inside the atlas) as seen from `eye` in scene coordinates, and
  /// leaves every other texel as it is, or, with `clear`, mid-grey of coverage 0. Returns texels shaded.
  std::uint64_t record(const vk::raii::CommandBuffer& commands, std::span<const PlacedPatch> patches,
                       const glm::dvec3& eye, bool clear);

  /// What record() draws to; change its use with use_image().
  [[nodiscard]] Image& atlas() { return atlas_; }

 private:
  /// Host-written geometry of one recording.
  struct Frame {
    std::optional<Buffer> corners;
    std::optional<Buffer> indices;
  };
  /// Patches of one material in the index buffer.
  struct Draw {
    std::size_t material = 0;
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
  };
  void reserve(Frame& frame, std::size_t patches);
  std::uint64_t write_geometry(Frame& frame, std::span<const PlacedPatch> patches);
  void draw(const vk::raii::CommandBuffer& commands, const Frame& frame, const glm::dvec3& eye);

  Device* device_;
  const SceneGpu* scene_;
  MaterialPipelines pipelines_;
  Image atlas_;
  std::vector<Frame> frames_;
  std::size_t next_frame_ = 0;
  std::vector<Draw> draws_;
};

}  // namespace atlaswire::render
