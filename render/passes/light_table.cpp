#include "render/passes/light_table.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <limits>
#include <numeric>
#include <span>

namespace atlaswire::render {
namespace {

/// Beside the dark one.
constexpr std::size_t kRoom = gpu_layout::kMaxLights - 1;
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

/// What of a patch lights meet.
struct PatchReach {
  Box box;
  std::array<glm::vec3, kMaxPatchCorners> positions{};
  std::array<glm::vec3, kMaxPatchCorners> normals{};
  std::uint32_t corners = 0;
  bool both_sides = false;
};

PatchReach reach_of(const Scene& scene, const Patch& patch) {
  PatchReach reach;
  reach.corners = corner_count(patch.triangles);
  reach.both_sides = scene.materials[patch.material].draw.double_sided;
  for (std::uint32_t i = 0; i < reach.corners; ++i) {
    const ShadingVertex& v = scene.vertices[patch.vertices[i]];
    reach.positions[i] = v.position;
    reach.normals[i] = unpack_normal(v.normal);
    reach.box.low = i == 0 ? v.position : glm::min(reach.box.low, v.position);
    reach.box.high = i == 0 ? v.position : glm::max(reach.box.high, v.position);
  }
  return reach;
}

/// Inside, normal and position are mixes of the corners': if no corner's normal faces the light from any
/// corner's position, none in between does.
bool reaches(const PunctualLight& light, const PatchReach& patch) {
  const glm::vec3 away = glm::clamp(light.position, patch.box.low, patch.box.high) - light.position;
  if (glm::dot(away, away) >= light.range * light.range) return false;
  if (patch.both_sides) return true;
  for (std::uint32_t n = 0; n < patch.corners; ++n) {
    for (std::uint32_t p = 0; p < patch.corners; ++p) {
      if (glm::dot(patch.normals[n], light.position - patch.positions[p]) > 0.0F) return true;
    }
  }
  return false;
}

/// Where a list is, appended unless it is empty or equals the one at `last`.
std::uint32_t append(std::vector<std::uint32_t>& lists, const std::vector<std::uint32_t>& list,
                     std::uint32_t last) {
  if (list.empty()) return 0;
  if (lists[last] == list.size() && std::equal(list.begin(), list.end(), lists.begin() + last + 1))
    return last;
  const auto at = static_cast<std::uint32_t>(lists.size());
  lists.push_back(static_cast<std::uint32_t>(list.size()));
  lists.insert(lists.end(), list.begin(), list.end());
  return at;
}

}  // namespace

LightTable make_light_table(const Scene& scene) {
  const std::size_t count = scene.lights.size();
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  if (count > kRoom) {
    std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) {
      return weight(scene.lights[a]) > weight(scene.lights[b]);
    });
    order.resize(kRoom);
  }

  LightTable table;
  table.lights.push_back(constants_of({.range = 1.0F, .color = glm::vec3{0.0F}}));
  table.dropped = static_cast<std::uint32_t>(count - order.size());
  std::vector<std::uint32_t> place(count, kDropped);
  for (const std::uint32_t light : order) {
    place[light] = static_cast<std::uint32_t>(table.lights.size());
    table.lights.push_back(constants_of(scene.lights[light]));
    table.spots = table.spots || is_spot(scene.lights[light]);
  }
  table.of_patch.resize(scene.patches.size());
  std::vector<std::uint32_t> list;
  for (const Chunk& chunk : scene.chunks) {
    const auto reaching = std::span(scene.light_lists).subspan(chunk.first_light, chunk.light_count);
    list.clear();
    for (const std::uint32_t light : reaching) {
      if (place[light] != kDropped) list.push_back(place[light]);
    }
    std::uint32_t last = append(table.lists, list, 0);
    table.of_chunk.push_back(last);
    for (const std::uint32_t p : patches_of(scene, chunk)) {
      list.clear();
      const PatchReach patch = reach_of(scene, scene.patches[p]);
      for (const std::uint32_t light : reaching) {
        if (place[light] != kDropped && reaches(scene.lights[light], patch)) list.push_back(place[light]);
      }
      last = append(table.lists, list, last);
      table.of_patch[p] = last;
    }
  }
  return table;
}

}  // namespace atlaswire::render
