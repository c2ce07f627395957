#include "render/scene/light_lists.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace atlaswire::render {

bool reaches(const PunctualLight& light, const Box& box) {
  const glm::vec3 nearest = glm::clamp(light.position, box.low, box.high);
  const glm::vec3 way = nearest - light.position;
  return glm::dot(way, way) <= light.range * light.range;
}

float implied_range(const glm::vec3& color) {
  return std::clamp(std::sqrt(100.0F * std::max({color.x, color.y, color.z})), 0.1F, 100.0F);
}

void list_lights(Scene& scene) {
  scene.light_lists.clear();
  for (Chunk& chunk : scene.chunks) {
    chunk.first_light = static_cast<std::uint32_t>(scene.light_lists.size());
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
      if (reaches(scene.lights[i], chunk.box)) scene.light_lists.push_back(i);
    }
    chunk.light_count = static_cast<std::uint32_t>(scene.light_lists.size()) - chunk.first_light;
  }
}

}  // namespace atlaswire::render
