#include "render/scene/deformed_frames.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace atlaswire::render {

DeformedFrames::DeformedFrames(std::vector<Triangle> triangles, std::span<const glm::vec3> rest)
    : triangles_(std::move(triangles)), along_(rest.size(), 0) {
  for (std::uint32_t p = 0; p < along_.size(); ++p) along_[p] = p;
  for (const Triangle& t : triangles_) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (along_[t[c]] == t[c]) along_[t[c]] = t[(c + 1) % 3];
    }
  }
  find_frames(rest, rest_);
}

void DeformedFrames::find_frames(std::span<const glm::vec3> positions, std::vector<glm::mat3>& frames) {
  normals_.assign(positions.size(), glm::vec3(0.0F));
  for (const Triangle& t : triangles_) {
    const glm::vec3 across = glm::cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]]);
    for (const std::uint32_t point : t) normals_[point] += across;
  }
  frames.resize(positions.size());
  for (std::size_t p = 0; p < positions.size(); ++p) {
    const glm::vec3 normal = glm::normalize(normals_[p]);
    const glm::vec3 edge = positions[along_[p]] - positions[p];
    const glm::vec3 along = glm::normalize(edge - normal * glm::dot(edge, normal));
    const bool is_frame = std::isfinite(glm::dot(normal, normal) + glm::dot(along, along));
    frames[p] = is_frame ? glm::mat3(along, glm::cross(normal, along), normal) : glm::mat3(0.0F);
  }
}

void DeformedFrames::turn(std::span<const glm::vec3> positions, std::span<const std::uint32_t> points,
                          std::span<const ShadingVertex> rest, std::span<ShadingVertex> out) {
  find_frames(positions, now_);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].normal = rest[i].normal;
    out[i].tangent = rest[i].tangent;
    const glm::mat3& from = rest_[points[i]];
    const glm::mat3& to = now_[points[i]];
    if (from[2] == glm::vec3(0.0F) || to[2] == glm::vec3(0.0F)) continue;
    const glm::mat3 turned = to * glm::transpose(from);
    out[i].normal = pack_normal(turned * unpack_normal(rest[i].normal));
    out[i].tangent =
        pack_tangent(turned * unpack_tangent(rest[i].tangent), is_negative_handed(rest[i].tangent));
  }
}

}  // namespace atlaswire::render
