#include "render/passes/shadow_fit.h"

#include "render/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace atlaswire::render {

ShadowFit fit_shadow(std::span<const ShadingVertex> vertices, const glm::vec3& direction, float size) {
  const glm::vec3 forward = -glm::normalize(direction);
  const glm::vec3 other =
      std::abs(forward.x) < 0.9F ? glm::vec3{1.0F, 0.0F, 0.0F} : glm::vec3{0.0F, 0.0F, 1.0F};
  const glm::vec3 up = glm::normalize(glm::cross(forward, other));
  const std::array<glm::vec3, 3> axes{glm::cross(up, forward), up, forward};

  glm::vec3 low{std::numeric_limits<float>::max()};
  glm::vec3 high{std::numeric_limits<float>::lowest()};
  for (const ShadingVertex& v : vertices) {
    const glm::vec3 p{glm::dot(v.position, axes[0]), glm::dot(v.position, axes[1]),
                      glm::dot(v.position, axes[2])};
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  if (vertices.empty()) low = high = glm::vec3{0.0F};

  // Room for the filter's width, and for depths that must not clip.
  const glm::vec3 size_of_box = glm::max(high - low, glm::vec3{1e-3F});
  const glm::vec3 margin = size_of_box * glm::vec3{4.0F / size, 4.0F / size, 1e-3F};
  low -= margin;
  const glm::vec3 extent = size_of_box + 2.0F * margin;
  ShadowFit fit;
  for (int i = 0; i < 3; ++i) {
    fit.rows[static_cast<std::size_t>(i)] =
        glm::vec4{axes[static_cast<std::size_t>(i)] / extent[i], -low[i] / extent[i]};
  }
  fit.texel = std::max(extent.x, extent.y) / size;
  fit.depth = extent.z;
  return fit;
}

}  // namespace atlaswire::render
