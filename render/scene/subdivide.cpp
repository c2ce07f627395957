#include "render/scene/subdivide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <unordered_map>
#include <vector>

namespace atlaswire::render {

namespace {

constexpr int kMostRounds = 24;  // each halves the longest edge

glm::vec3 normalized_or(const glm::vec3& v, const glm::vec3& fallback) {
  const float length = glm::length(v);
  return length > 0.0F && std::isfinite(length) ? v / length : fallback;
}

SourceVertex middle(const SourceVertex& a, const SourceVertex& b) {
  SourceVertex m;
  m.position = 0.5F * (a.position + b.position);
  m.normal = normalized_or(a.normal + b.normal, a.normal);
  m.tangent = glm::vec4(normalized_or(glm::vec3(a.tangent) + glm::vec3(b.tangent), glm::vec3(a.tangent)),
                        a.tangent.w);
  m.uv = 0.5F * (a.uv + b.uv);
  return m;
}

/// One round over a mesh: every too long edge gets its middle.
class Round {
 public:
  Round(SourceMesh& mesh, float longest) : mesh_(mesh), limit_(longest * longest) {}

  /// Were any edges split?
  bool run() {
    std::vector<std::uint32_t> out;
    out.reserve(mesh_.indices.size());
    for (std::size_t i = 0; i + 2 < mesh_.indices.size(); i += 3) {
      split({mesh_.indices[i], mesh_.indices[i + 1], mesh_.indices[i + 2]}, out);
    }
    mesh_.indices = std::move(out);
    return !middles_.empty();
  }

 private:
  using Corners = std::array<std::uint32_t, 3>;

  [[nodiscard]] float squared_length(std::uint32_t a, std::uint32_t b) const {
    const glm::vec3 way = mesh_.vertices[b].position - mesh_.vertices[a].position;
    return glm::dot(way, way);
  }

  std::uint32_t middle_of(std::uint32_t a, std::uint32_t b) {
    const std::uint64_t key = (std::uint64_t{std::min(a, b)} << 32U) | std::max(a, b);
    const auto [entry, fresh] = middles_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (fresh) mesh_.vertices.push_back(middle(mesh_.vertices[a], mesh_.vertices[b]));
    return entry->second;
  }

  void split(const Corners& c, std::vector<std::uint32_t>& out) {
    const auto put = [&out](std::uint32_t a, std::uint32_t b, std::uint32_t d) {
      out.insert(out.end(), {a, b, d});
    };
    const bool too_long[3] = {squared_length(c[0], c[1]) > limit_, squared_length(c[1], c[2]) > limit_,
                              squared_length(c[2], c[0]) > limit_};
    const int count = too_long[0] + too_long[1] + too_long[2];
    if (count == 0) return put(c[0], c[1], c[2]);
    if (count == 3) {
      const std::uint32_t m0 = middle_of(c[0], c[1]);
      const std::uint32_t m1 = middle_of(c[1], c[2]);
      const std::uint32_t m2 = middle_of(c[2], c[0]);
      put(c[0], m0, m2);
      put(m0, c[1], m1);
      put(m2, m1, c[2]);
      return put(m0, m1, m2);
    }
    // Turned so that edge 0-1 is split, and with two, 1-2 as well.
    std::size_t first = 0;
    while (!(too_long[first] && (count == 1 || too_long[(first + 1) % 3]))) ++first;
    const std::uint32_t a = c[first];
    const std::uint32_t b = c[(first + 1) % 3];
    const std::uint32_t d = c[(first + 2) % 3];
    const std::uint32_t ab = middle_of(a, b);
    if (count == 1) {
      put(a, ab, d);
      return put(ab, b, d);
    }
    const std::uint32_t bd = middle_of(b, d);
    put(ab, b, bd);
    put(a, ab, bd);
    put(a, bd, d);
  }

  SourceMesh& mesh_;
  float limit_;
  std::unordered_map<std::uint64_t, std::uint32_t> middles_;
};

/// Triangles beyond the one that there is, after splitting at `longest`: by area and by length.
double added_triangles(const SourceMesh& mesh, float longest) {
  double added = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::vec3 a = mesh.vertices[mesh.indices[i]].position;
    const glm::vec3 ab = mesh.vertices[mesh.indices[i + 1]].position - a;
    const glm::vec3 ac = mesh.vertices[mesh.indices[i + 2]].position - a;
    const float edge = std::max({glm::length(ab), glm::length(ac), glm::length(ac - ab)});
    if (!(edge > longest)) continue;
    const double area = 0.5 * static_cast<double>(glm::length(glm::cross(ab, ac)));
    added += 1 + static_cast<double>(edge / longest) +
             4 * area / (static_cast<double>(longest) * static_cast<double>(longest));
  }
  return added;
}

}  // namespace

void subdivide(SourceMesh& mesh, float longest) {
  for (int round = 0; round < kMostRounds && Round(mesh, longest).run(); ++round) {
  }
}

float suited_longest_edge(const SceneSource& source) {
  constexpr float kShortest = 1.5F;
  constexpr double kFree = 30'000;
  double triangles = 0;
  std::vector<double> placed(source.meshes.size(), 0);
  for (const SourceInstance& instance : source.instances) {
    placed[instance.mesh] += 1;
    triangles += static_cast<double>(source.meshes[instance.mesh].indices.size()) / 3;
  }
  float longest = kShortest;
  for (int doubling = 0; doubling < 20; ++doubling, longest *= 2) {
    double added = 0;
    for (std::size_t m = 0; m < source.meshes.size(); ++m) {
      if (placed[m] > 0) added += placed[m] * added_triangles(source.meshes[m], longest);
    }
    if (added <= std::max(kFree, triangles / 3)) break;
  }
  return longest;
}

}  // namespace atlaswire::render
