#include "render/scene/source.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace atlaswire::render {
namespace {

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

void split_all_vertices(SourceMesh& mesh) {
  std::vector<SourceVertex> split;
  split.reserve(mesh.indices.size());
  for (std::uint32_t& index : mesh.indices) {
    split.push_back(mesh.vertices[index]);
    index = static_cast<std::uint32_t>(split.size() - 1);
  }
  mesh.vertices = std::move(split);
}

/// Angle between two vectors without the digits that acos loses.
float angle_between(const glm::vec3& a, const glm::vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Twice the signed area of a triangle in texture space: negative where the mapping is mirrored.
float uv_area(const SourceMesh& mesh, std::size_t first) {
  const glm::vec2 a = mesh.vertices[mesh.indices[first]].uv;
  const glm::vec2 ab = mesh.vertices[mesh.indices[first + 1]].uv - a;
  const glm::vec2 ac = mesh.vertices[mesh.indices[first + 2]].uv - a;
  return ab.x * ac.y - ac.x * ab.y;
}

/// Gives every vertex one handedness, in tangent.w, by copying those that triangles of both use.
void split_by_handedness(SourceMesh& mesh) {
  for (SourceVertex& v : mesh.vertices) v.tangent = glm::vec4(0.0F);
  std::vector<std::uint32_t> mirrored_copy(mesh.vertices.size(), kNoVertex);
  for (std::size_t first = 0; first < mesh.indices.size(); first += 3) {
    const float sign = uv_area(mesh, first) < 0.0F ? -1.0F : 1.0F;
    for (std::size_t corner = first; corner < first + 3; ++corner) {
      std::uint32_t& index = mesh.indices[corner];
      if (mesh.vertices[index].tangent.w == 0.0F) mesh.vertices[index].tangent.w = sign;
      if (mesh.vertices[index].tangent.w == sign) continue;
      if (mirrored_copy[index] == kNoVertex) {
        mirrored_copy[index] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(mesh.vertices[index]);
        mesh.vertices.back().tangent.w = sign;
      }
      index = mirrored_copy[index];
    }
  }
}

glm::vec3 any_perpendicular(const glm::vec3& n) {
  const glm::vec3 axis = std::abs(n.x) < 0.7F ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 t = axis - n * glm::dot(axis, n);
  const float length = glm::length(t);
  return length > 0.0F ? t / length : glm::vec3(1, 0, 0);
}

}  // namespace

void compute_normals(SourceMesh& mesh, bool flat) {
  if (flat) split_all_vertices(mesh);
  for (SourceVertex& v : mesh.vertices) v.normal = glm::vec3(0.0F);
  for (std::size_t first = 0; first + 2 < mesh.indices.size(); first += 3) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      SourceVertex& v = mesh.vertices[mesh.indices[first + corner]];
      const glm::vec3 to_next = mesh.vertices[mesh.indices[first + (corner + 1) % 3]].position - v.position;
      const glm::vec3 to_last = mesh.vertices[mesh.indices[first + (corner + 2) % 3]].position - v.position;
      v.normal += glm::cross(to_next, to_last) * angle_between(to_next, to_last);
    }
  }
  for (SourceVertex& v : mesh.vertices) {
    const float length = glm::length(v.normal);
    v.normal = length > 0.0F && std::isfinite(length) ? v.normal / length : glm::vec3(0, 1, 0);
  }
}

void compute_tangents(SourceMesh& mesh) {
  split_by_handedness(mesh);
  std::vector<glm::vec3> sums(mesh.vertices.size(), glm::vec3(0.0F));
  for (std::size_t first = 0; first + 2 < mesh.indices.size(); first += 3) {
    const SourceVertex& a = mesh.vertices[mesh.indices[first]];
    const SourceVertex& b = mesh.vertices[mesh.indices[first + 1]];
    const SourceVertex& c = mesh.vertices[mesh.indices[first + 2]];
    const float area = uv_area(mesh, first);
    if (area == 0.0F) continue;
    // Weighted by |uv area| by not dividing by it: only the direction is kept.
    const glm::vec3 along_u =
        ((b.position - a.position) * (c.uv.y - a.uv.y) - (c.position - a.position) * (b.uv.y - a.uv.y)) *
        (area < 0.0F ? -1.0F : 1.0F);
    for (std::size_t corner = 0; corner < 3; ++corner) sums[mesh.indices[first + corner]] += along_u;
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    SourceVertex& v = mesh.vertices[i];
    const glm::vec3 t = sums[i] - v.normal * glm::dot(v.normal, sums[i]);
    const float length = glm::length(t);
    const bool sound = length > 1e-20F && std::isfinite(length);
    v.tangent =
        glm::vec4(sound ? t / length : any_perpendicular(v.normal), v.tangent.w < 0.0F ? -1.0F : 1.0F);
  }
}

}  // namespace atlaswire::render
