#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

namespace atlaswire::render {

/// Linear 0..1 to sRGB-encoded 0..1 (IEC 61966-2-1).
inline float encode_srgb(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

/// The inverse.
inline float decode_srgb(float encoded) {
  return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

/// Radiance to a display's encoded colour in 0..1: what every pass writes. Mirrors shaders/tonemap.glsl.
inline glm::vec3 display_color(const glm::vec3& radiance, float exposure) {
  const auto channel = [exposure](float r) {
    const float x = std::max(r * exposure, 0.0F);
    return encode_srgb(std::clamp(x * (2.51F * x + 0.03F) / (x * (2.43F * x + 0.59F) + 0.14F), 0.0F, 1.0F));
  };
  return {channel(radiance.x), channel(radiance.y), channel(radiance.z)};
}

}  // namespace atlaswire::render
