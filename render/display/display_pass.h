#pragma once

#include "render/camera.h"
#include "render/display/atlas_texture.h"
#include "render/display/display_mesh.h"
#include "render/gpu/pipeline.h"
#include "render/image/picture.h"

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

namespace atlaswire::render {

struct OffscreenTarget;

/// The client's redraw of pre-shaded triangles for its newest pose ([SAS] 3.6): one draw for a scene of
/// opaque single-sided patches, one more for each other class that occurs. One thread at a time.
class DisplayPass {
 public:
  /// `background`: encoded colour 0..1 where nothing is drawn (display_color of the scene's).
  DisplayPass(Device& device, const AtlasTexture& atlas, const glm::vec3& background);
  ~DisplayPass();

  /// Draws the mesh with the atlas's slot, and waits.
  void draw(const DisplayMesh& mesh, std::uint32_t slot, const Camera& camera);
  /// The last picture drawn; empty before the first. Alpha: 255 where opaque or masked geometry was hit, 0
  /// where nothing was drawn. Valid until the next call.
  const Picture& read_back();
  /// What draw() drew into; null before the first, and another one whenever a camera has another extent.
  [[nodiscard]] OffscreenTarget* target() { return target_.get(); }

 private:
  const Pipeline& pipeline(PatchClass::Alpha alpha, bool double_sided);
  void prepare(const DisplayMesh& mesh, const Camera& camera);
  void record(const vk::raii::CommandBuffer& commands, const DisplayMesh& mesh, std::uint32_t slot,
              const Camera& camera);
  void draw_classes(const vk::raii::CommandBuffer& commands, const DisplayMesh& mesh, std::uint32_t slot,
                    const Camera& camera);

  SubmitContext context_;
  const AtlasTexture* atlas_;
  glm::vec3 background_;
  vk::raii::Sampler sampler_;
  DescriptorLayout layout_;
  DescriptorSets sets_;                                                ///< by slot
  std::array<std::array<std::unique_ptr<Pipeline>, 2>, 3> pipelines_;  ///< made when first needed
  std::unique_ptr<OffscreenTarget> target_;                            ///< of the last camera's extent
  std::vector<std::uint32_t> sorted_;                                  ///< indices of blended triangles
  std::optional<Buffer> sorted_buffer_;
  Picture picture_;
};

}  // namespace atlaswire::render
