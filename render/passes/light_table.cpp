#include "render/passes/light_table.h"

#include <algorithm>
#include <glm/packing.hpp>
#include <limits>
#include <numeric>

namespace atlaswire::render {
namespace {

constexpr std::uint32_t kDropped = std::numeric_limits<std::uint32_t>::max();

float weight(const PunctualLight& light) {
  return std::max({light.color.x, light.color.y, light.color.z}) * light.range;
}

bool is_spot(const PunctualLight& light) { return light.cos_outer > -1.5F; }

std::uint32_t halves(float low, float high) {
  constexpr float kLargest = 65504.0F;
  return glm::packHalf2x16({std::min(low, kLargest), std::min(high, kLargest)});
}

gpu_layout::LightConstants constants_of(const PunctualLight& light) {
  const float scale = is_spot(light) ? 1.0F / std::max(light.cos_inner - light.cos_outer, 1e-3F) : 0.0F;
  const float offset = is_spot(light) ? -light.cos_outer * scale : 1.0F;
  return {.position = light.position,
          .color_rg = halves(light.color.x, light.color.y),
          .color_b_inverse_range = halves(light.color.z, 1.0F / light.range),
          .axis = pack_normal(-light.direction),
          .cone_scale_offset = halves(scale, offset)};
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
    table.spots = table.spots || is_spot(scene.lights[light]);
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
