#pragma once

#include "render/scene/scene.h"

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

namespace atlaswire::render::test {

/// Makes small scenes by hand: patches of flat triangles, one chunk a material, every light in every chunk.
/// No ambient light, no sun and exposure 1 unless the test sets them in `scene`.
class SceneBuilder {
 public:
  SceneBuilder();

  std::uint16_t material(const Material& material);
  std::int32_t texture(Texture texture);
  /// Corners in the order of base/patch_layout.h; counter-clockwise in front. The number of corners gives the
  /// number of triangles.
  void patch(std::uint16_t material, std::span<const glm::vec3> corners, std::span<const glm::vec2> uvs);
  /// A two-triangle rectangle from `corner` along `right` (u) and `up` (v), facing cross(right, up). Its uv
  /// runs from (0,1) at the corner to (1,0): texture rows from the top.
  void rectangle(std::uint16_t material, const glm::vec3& corner, const glm::vec3& right,
                 const glm::vec3& up);

  /// Sorts patches by material and finishes the scene's tables. PatchIds follow.
  [[nodiscard]] std::shared_ptr<const Scene> build();

  Scene scene;

 private:
  struct Pending {
    std::uint16_t material;
    std::vector<glm::vec3> corners;
    std::vector<glm::vec2> uvs;
  };
  void add(const Pending& pending);

  std::vector<Pending> pending_;
};

/// A material that only emits: every pixel of it is display_color(emissive).
Material glowing(const glm::vec3& emissive);

}  // namespace atlaswire::render::test
