#include "render/scene/shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace atlaswire::render {

namespace {

constexpr float kTau = 2.0F * std::numbers::pi_v<float>;

/// Normals of a sheet by central differences of its own grid, wrapping where both ends meet.
void shade_sheet(SourceMesh& mesh, std::uint32_t columns, std::uint32_t rows) {
  const auto at = [&](std::uint32_t c, std::uint32_t r) -> SourceVertex& {
    return mesh.vertices[r * (columns + 1) + c];
  };
  const auto closed = [&](std::uint32_t r) {
    return glm::distance(at(0, r).position, at(columns, r).position) < 1e-5F;
  };
  for (std::uint32_t r = 0; r <= rows; ++r) {
    const bool wraps = closed(r);
    for (std::uint32_t c = 0; c <= columns; ++c) {
      const std::uint32_t left = c > 0 ? c - 1 : wraps ? columns - 1 : 0;
      const std::uint32_t right = c < columns ? c + 1 : wraps ? 1 : columns;
      const glm::vec3 along_u = at(right, r).position - at(left, r).position;
      const glm::vec3 along_v = at(c, std::min(r + 1, rows)).position - at(c, r > 0 ? r - 1 : 0).position;
      const glm::vec3 n = glm::cross(along_u, along_v);
      const float length = glm::length(n);
      at(c, r).normal = length > 0.0F ? n / length : glm::vec3(0, 1, 0);
    }
  }
}

}  // namespace

std::uint32_t pieces(std::uint32_t at_detail_one, double detail, std::uint32_t least) {
  const double scaled = std::round(at_detail_one * std::sqrt(detail));
  return std::max(least, static_cast<std::uint32_t>(scaled));
}

SourceMesh sheet(std::uint32_t columns, std::uint32_t rows,
                 const std::function<SourceVertex(float, float)>& at) {
  SourceMesh mesh;
  for (std::uint32_t r = 0; r <= rows; ++r) {
    for (std::uint32_t c = 0; c <= columns; ++c) {
      mesh.vertices.push_back(at(static_cast<float>(c) / static_cast<float>(columns),
                                 static_cast<float>(r) / static_cast<float>(rows)));
    }
  }
  for (std::uint32_t r = 0; r < rows; ++r) {
    for (std::uint32_t c = 0; c < columns; ++c) {
      const std::uint32_t a = r * (columns + 1) + c;
      const std::uint32_t d = a + columns + 1;
      mesh.indices.insert(mesh.indices.end(), {a, a + 1, d + 1, a, d + 1, d});
    }
  }
  shade_sheet(mesh, columns, rows);
  return mesh;
}

SourceMesh revolve(const Revolution& shape) {
  const auto segments = static_cast<std::uint32_t>(shape.profile.size() - 1);
  const std::uint32_t rows = segments * shape.between;
  std::vector<float> arc{0.0F};  // metres along the profile, so that flat rims are not smeared
  for (std::uint32_t i = 0; i < segments; ++i) {
    arc.push_back(arc.back() + glm::distance(shape.profile[i], shape.profile[i + 1]));
  }
  return sheet(shape.around, rows, [&](float u, float v) {
    const float along = v * static_cast<float>(segments);
    const auto segment = std::min(static_cast<std::uint32_t>(along), segments - 1);
    const float part = along - static_cast<float>(segment);
    const glm::vec2 p = glm::mix(shape.profile[segment], shape.profile[segment + 1], part);
    // At u = 1 the angle is exactly 0 again, so that the seam's points are equal.
    const float angle = u < 1.0F ? -kTau * u : 0.0F;
    const float groove =
        shape.flutes > 0 ? 0.5F - 0.5F * std::cos(angle * static_cast<float>(shape.flutes)) : 0.0F;
    const float radius = p.x * (1.0F - shape.flute_depth * groove * groove);
    SourceVertex out;
    out.position = {radius * std::cos(angle), p.y, radius * std::sin(angle)};
    out.uv = {u * shape.uv_scale.x, -glm::mix(arc[segment], arc[segment + 1], part) * shape.uv_scale.y};
    return out;
  });
}

SourceMesh box(const glm::vec3& low, const glm::vec3& high, float cell, float uv_scale) {
  SourceMesh mesh;
  const glm::vec3 size = high - low;
  // Each face: the axis it looks along, its side, and the axes of u and v so that u x v points outwards.
  constexpr struct {
    int axis, u, v;
    bool positive;
  } kFaces[] = {{0, 1, 2, true},  {0, 2, 1, false}, {1, 2, 0, true},
                {1, 0, 2, false}, {2, 0, 1, true},  {2, 1, 0, false}};
  for (const auto& face : kFaces) {
    const auto cut = [cell](float length) {
      return std::max(1U, static_cast<std::uint32_t>(std::ceil(length / cell)));
    };
    append(mesh, sheet(cut(size[face.u]), cut(size[face.v]), [&](float u, float v) {
             SourceVertex out;
             out.position = low;
             out.position[face.axis] = face.positive ? high[face.axis] : low[face.axis];
             out.position[face.u] = low[face.u] + u * size[face.u];
             out.position[face.v] = low[face.v] + v * size[face.v];
             // Texture v runs down the world's height where there is one.
             const int across = face.u == 1 ? face.v : face.u;
             const int up = face.u == 1 ? face.u : face.v;
             out.uv = {out.position[across] * uv_scale, -out.position[up] * uv_scale};
             return out;
           }));
  }
  return mesh;
}

void append(SourceMesh& mesh, const SourceMesh& more) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const std::uint32_t index : more.indices) mesh.indices.push_back(base + index);
}

}  // namespace atlaswire::render
