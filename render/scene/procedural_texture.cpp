#include "render/scene/procedural_texture.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace atlaswire::render {

namespace {

float lattice(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
  std::uint32_t h = x * 0x8DA6B343U ^ y * 0xD8163841U ^ seed * 0xCB1AB31FU;
  h ^= h >> 15U;
  h *= 0x2C1B3C6DU;
  h ^= h >> 12U;
  h *= 0x297A2D39U;
  h ^= h >> 15U;
  return static_cast<float>(h & 0xFFFFFFU) / 16777215.0F;
}

std::uint8_t octet(float v) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0F, 1.0F) * 255.0F));
}

glm::vec2 texel_centre(std::uint32_t x, std::uint32_t y, std::uint32_t side) {
  return (glm::vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5F) / static_cast<float>(side);
}

}  // namespace

float tiled_noise(glm::vec2 uv, std::uint32_t period, std::uint32_t seed) {
  const glm::vec2 wrapped = uv - glm::floor(uv);
  const glm::vec2 scaled = wrapped * static_cast<float>(period);
  const auto x = static_cast<std::uint32_t>(scaled.x) % period;
  const auto y = static_cast<std::uint32_t>(scaled.y) % period;
  const glm::vec2 f = scaled - glm::floor(scaled);
  const glm::vec2 s = f * f * (3.0F - 2.0F * f);
  const std::uint32_t x1 = (x + 1) % period;
  const std::uint32_t y1 = (y + 1) % period;
  return glm::mix(glm::mix(lattice(x, y, seed), lattice(x1, y, seed), s.x),
                  glm::mix(lattice(x, y1, seed), lattice(x1, y1, seed), s.x), s.y);
}

float tiled_fbm(glm::vec2 uv, std::uint32_t period, std::uint32_t octaves, std::uint32_t seed) {
  float sum = 0.0F;
  float weight = 0.5F;
  float total = 0.0F;
  for (std::uint32_t o = 0; o < octaves; ++o) {
    sum += weight * tiled_noise(uv, period << o, seed + o);
    total += weight;
    weight *= 0.5F;
  }
  return sum / total;
}

Texture paint(const char* name, std::uint32_t side, bool srgb,
              const std::function<glm::vec4(glm::vec2)>& at) {
  Texture texture;
  texture.name = name;
  texture.extent = {side, side};
  texture.srgb = srgb;
  texture.rgba.reserve(std::size_t{side} * side * 4);
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const glm::vec4 c = at(texel_centre(x, y, side));
      texture.rgba.insert(texture.rgba.end(), {octet(c.x), octet(c.y), octet(c.z), octet(c.w)});
    }
  }
  return texture;
}

Texture normals_of(const char* name, std::uint32_t side, float depth,
                   const std::function<float(glm::vec2)>& height) {
  std::vector<float> heights;
  heights.reserve(std::size_t{side} * side);
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) heights.push_back(height(texel_centre(x, y, side)));
  }
  const auto at = [&](std::uint32_t x, std::uint32_t y) {
    return heights[std::size_t{y % side} * side + x % side];
  };
  const float slope = depth * 0.5F * static_cast<float>(side);
  return paint(name, side, false, [&](glm::vec2 uv) {
    const auto x = static_cast<std::uint32_t>(uv.x * static_cast<float>(side));
    const auto y = static_cast<std::uint32_t>(uv.y * static_cast<float>(side));
    const float du = (at(x + 1, y) - at(x + side - 1, y)) * slope;
    const float dv = (at(x, y + 1) - at(x, y + side - 1)) * slope;
    // glTF: +Y of the map is up, against texture v.
    const glm::vec3 n = glm::normalize(glm::vec3(-du, dv, 1.0F));
    return glm::vec4(n * 0.5F + 0.5F, 1.0F);
  });
}

}  // namespace atlaswire::render
