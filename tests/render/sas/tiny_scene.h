#pragma once

#include "render/scene/scene.h"

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

namespace atlaswire::render::test {

/// Builds small scenes by hand: one patch a call, one chunk and material a `material()` call.
class TinyScene {
 public:
  /// `origin`: added to what float positions say.
  explicit TinyScene(const glm::dvec3& origin = glm::dvec3{0.0});

  /// Starts a material and a chunk of its own; call in the order opaque, masked, blended.
  void material(PatchClass draw, std::int32_t texture = kNoTexture);
  /// A square RGBA8 texture, sampled nearest. Returns its index.
  std::int32_t texture(std::uint32_t side, std::vector<std::uint8_t> rgba);
  /// A patch of corners.size() - 2 triangles (3, 4 or 5 corners), counter-clockwise in front; texture
  /// coordinates follow the patch layout.
  PatchId patch(const std::vector<glm::vec3>& corners);
  /// A quad facing +Z at depth z.
  PatchId wall(float left, float bottom, float right, float top, float z);

  [[nodiscard]] std::shared_ptr<const Scene> finish();

 private:
  std::shared_ptr<Scene> scene_;
};

}  // namespace atlaswire::render::test
