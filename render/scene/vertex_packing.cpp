#include "render/scene/scene.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace atlaswire::render {
namespace {

glm::vec2 octahedral(const glm::vec3& n) {
  const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (!(sum > 0.0F)) return {0.0F, 0.0F};
  const glm::vec2 p{n.x / sum, n.y / sum};
  if (n.z >= 0.0F) return p;
  return {(1.0F - std::abs(p.y)) * (p.x >= 0.0F ? 1.0F : -1.0F),
          (1.0F - std::abs(p.x)) * (p.y >= 0.0F ? 1.0F : -1.0F)};
}

std::uint32_t snorm_half(float v, float scale) {
  const auto fixed = static_cast<std::int32_t>(std::lround(glm::clamp(v, -1.0F, 1.0F) * scale));
  return static_cast<std::uint32_t>(fixed) & 0xffffU;
}

}  // namespace

std::uint32_t pack_normal(const glm::vec3& n) {
  const glm::vec2 o = octahedral(n);
  return snorm_half(o.x, 32767.0F) | (snorm_half(o.y, 32767.0F) << 16U);
}

glm::vec3 unpack_normal(std::uint32_t packed) {
  const auto half = [](std::uint32_t bits) {
    return std::max(-1.0F, static_cast<float>(static_cast<std::int16_t>(bits & 0xffffU)) / 32767.0F);
  };
  const float x = half(packed);
  const float y = half(packed >> 16U);
  glm::vec3 n{x, y, 1.0F - std::abs(x) - std::abs(y)};
  if (n.z < 0.0F) {
    n.x = (1.0F - std::abs(y)) * (x >= 0.0F ? 1.0F : -1.0F);
    n.y = (1.0F - std::abs(x)) * (y >= 0.0F ? 1.0F : -1.0F);
  }
  return glm::normalize(n);
}

std::uint32_t pack_tangent(const glm::vec3& t, bool negative_handed) {
  const glm::vec2 o = octahedral(t);
  const std::uint32_t x = (snorm_half(o.x, 16383.0F) << 1U) & 0xffffU;
  const std::uint32_t y = (snorm_half(o.y, 16383.0F) << 1U) & 0xffffU;
  return x | (y << 16U) | (negative_handed ? 1U : 0U);
}

glm::vec3 unpack_tangent(std::uint32_t packed) { return unpack_normal(packed & 0xfffefffeU); }

}  // namespace atlaswire::render
