#include "render/passes/light_table.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace atlaswire::render {
namespace {

constexpr std::uint32_t kDropped = std::numeric_limits<std::uint32_t>::max();

float weight(const PunctualLight& light) {
  return std::max({light.color.x, light.color.y, light.color.z}) * light.range;
}

gpu_layout::LightConstants constants_of(const PunctualLight& light) {
  const bool spot = light.cos_outer > -1.5F;
  const float scale = spot ? 1.0F / std::max(light.cos_inner - light.cos_outer, 1e-3F) : 0.0F;
  const float offset = spot ? -light.cos_outer * scale : 1.0F;
  return {.position = {light.position, 1.0F / (light.range * light.range)},
          .color = {light.color, scale},
          .axis = {-light.direction, offset}};
}

}  // namespace

LightTable make_light_table(const Scene& scene) {
  const std::size_t count = scene.lights.size();
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  if (count > gpu_layout::kMaxLights) {
    std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) {
      return weight(scene.lights[a]) > weight(scene.lights[b]);
    });
    order.resize(gpu_layout::kMaxLights);
  }

  LightTable table;
  table.dropped = static_cast<std::uint32_t>(count - order.size());
  std::vector<std::uint32_t> place(count, kDropped);
  for (const std::uint32_t light : order) {
    place[light] = static_cast<std::uint32_t>(table.lights.size());
    table.lights.push_back(constants_of(scene.lights[light]));
  }
  for (const Chunk& chunk : scene.chunks) {
    const auto first = static_cast<std::uint32_t>(table.list.size());
    for (std::uint32_t i = 0; i < chunk.light_count; ++i) {
      const std::uint32_t at = place[scene.light_lists[chunk.first_light + i]];
      if (at != kDropped) table.list.push_back(at);
    }
    table.chunk_ranges.push_back({first, static_cast<std::uint32_t>(table.list.size()) - first});
  }
  return table;
}

}  // namespace atlaswire::render
