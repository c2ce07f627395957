#include "render/passes/moved_vertices.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace atlaswire::render {

namespace {

std::size_t most_bytes(const Scene& scene, std::size_t solos) {
  std::size_t vertices = solos;
  for (const MovingPart& part : scene.motion->parts) vertices += part.vertices.count;
  return vertices * sizeof(ShadingVertex);
}

}  // namespace

ShadingVertex fourth_corner(const ShadingVertex& a, const ShadingVertex& b, const ShadingVertex& c) {
  const glm::vec3 first = unpack_normal(a.normal);
  const glm::vec3 across = unpack_normal(b.normal) + unpack_normal(c.normal) - first;
  return {.position = b.position + c.position - a.position,
          .normal = pack_normal(glm::dot(across, across) > 0.01F ? across : first),
          .tangent = b.tangent,
          .uv = b.uv + c.uv - a.uv};
}

MovedVertices::MovedVertices(const Device& device, const Scene& scene, std::span<const std::uint32_t> solos)
    : staging_(device, "moved vertices", most_bytes(scene, solos.size())) {
  for (const MovingPart& part : scene.motion->parts) {
    Part& mine = parts_.emplace_back();
    const auto first = std::ranges::lower_bound(solos, part.mover.first_patch);
    const auto end = std::ranges::lower_bound(solos, part.mover.end());
    mine.first_corner =
        static_cast<std::uint32_t>(scene.vertices.size() + static_cast<std::size_t>(first - solos.begin()));
    mine.solos.assign(first, end);
  }
}

bool MovedVertices::record(const vk::raii::CommandBuffer& commands, const Scene& scene,
                           const MovedScene& moved, const Buffer& vertices) {
  bool any = false;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& mine = parts_[i];
    if (mine.version == moved.version(i)) continue;
    mine.version = moved.version(i);
    any = true;
    const NumberRange& range = moved.parts()[i].vertices;
    const std::span<const ShadingVertex> now = moved.vertices(i);
    staging_.add(std::as_bytes(now), vertices, range.first * sizeof(ShadingVertex));
    corners_.clear();
    for (const std::uint32_t patch : mine.solos) {
      const auto& corner = scene.patches[patch].vertices;
      corners_.push_back(fourth_corner(now[corner[0] - range.first], now[corner[1] - range.first],
                                       now[corner[2] - range.first]));
    }
    staging_.add(std::as_bytes(std::span(corners_)), vertices, mine.first_corner * sizeof(ShadingVertex));
  }
  staging_.record(commands);
  return any;
}

}  // namespace atlaswire::render
