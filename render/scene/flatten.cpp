#include "render/scene/flatten.h"

#include "render/scene/scene_error.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace atlaswire::render {

namespace {

constexpr std::uint32_t kEmptySlot = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMostIndices = 3ULL * 64 * 1024 * 1024;

/// Numbers equal keys alike, in order of first appearance. Open addressing over the caller's values.
template <class Value>
class Deduplicator {
 public:
  explicit Deduplicator(std::vector<Value>& values, std::size_t expected) : values_(values) {
    slots_.assign(std::bit_ceil(expected * 2 + 16), kEmptySlot);
  }
  std::uint32_t number(const Value& v) {
    if (values_.size() * 2 > slots_.size()) grow();
    std::size_t slot = hash(v) & (slots_.size() - 1);
    while (slots_[slot] != kEmptySlot) {
      if (std::memcmp(&values_[slots_[slot]], &v, sizeof(Value)) == 0) return slots_[slot];
      slot = (slot + 1) & (slots_.size() - 1);
    }
    slots_[slot] = static_cast<std::uint32_t>(values_.size());
    values_.push_back(v);
    return slots_[slot];
  }

 private:
  static std::size_t hash(const Value& v) {
    static_assert(sizeof(Value) % 4 == 0);
    std::uint32_t words[sizeof(Value) / 4];
    std::memcpy(words, &v, sizeof(Value));
    std::uint64_t h = 0x9E3779B97F4A7C15ULL;
    for (const std::uint32_t w : words) {
      h = (h ^ w) * 0xFF51AFD7ED558CCDULL;
      h ^= h >> 32U;
    }
    return h;
  }
  void grow() {
    slots_.assign(slots_.size() * 2, kEmptySlot);
    for (std::uint32_t i = 0; i < values_.size(); ++i) {
      std::size_t slot = hash(values_[i]) & (slots_.size() - 1);
      while (slots_[slot] != kEmptySlot) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = i;
    }
  }
  std::vector<Value>& values_;
  std::vector<std::uint32_t> slots_;
};

/// Finite, and within the 1e9 m that poses and grids may name.
bool within_reach(const glm::dvec3& v) {
  constexpr double kFarthest = 1e9;
  return std::abs(v.x) <= kFarthest && std::abs(v.y) <= kFarthest && std::abs(v.z) <= kFarthest;
}

glm::dvec3 place(const SourceInstance& instance, const glm::vec3& p) {
  return glm::dvec3(instance.to_scene * glm::dvec4(glm::dvec3(p), 1.0));
}

/// -0 to +0, so that equal numbers have equal bits.
glm::vec3 canonical(const glm::vec3& v) { return v + glm::vec3(0.0F); }

struct Bounds {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
};

Result<Bounds> bounds_of(const SceneSource& source) {
  Bounds bounds;
  std::size_t indices = 0;
  for (const SourceInstance& instance : source.instances) {
    const SourceMesh& mesh = source.meshes[instance.mesh];
    indices += mesh.indices.size();
    if (indices > kMostIndices)
      return Error{SceneError::kTooLarge, source.name + ": more than 64 million triangles"};
    for (const std::uint32_t index : mesh.indices) {
      const glm::dvec3 p = place(instance, mesh.vertices[index].position);
      if (!within_reach(p))
        return Error{SceneError::kNotFinite, source.name + ": a vertex position, or it lies beyond 1e9 m"};
      bounds.low = glm::min(bounds.low, p);
      bounds.high = glm::max(bounds.high, p);
    }
  }
  if (indices == 0) return Error{SceneError::kEmpty, source.name};
  return bounds;
}

glm::vec3 direction(const glm::dmat3& m, const glm::vec3& v) {
  const glm::dvec3 d = m * glm::dvec3(v);
  const double length = glm::length(d);
  return length > 0 && std::isfinite(length) ? glm::vec3(d / length) : glm::vec3(0, 1, 0);
}

class Flattener {
 public:
  Flattener(FlatMesh& out, std::size_t expected) : out_(out), vertices_(out.vertices, expected) {}

  void add(const SourceMesh& mesh, const SourceInstance& instance) {
    const glm::dmat3 linear(instance.to_scene);
    const double determinant = glm::determinant(linear);
    const bool mirrored = determinant < 0;
    const glm::dmat3 normals =
        std::abs(determinant) > 0 ? glm::transpose(glm::inverse(linear)) : glm::dmat3(1.0);
    std::vector<std::uint32_t> numbers(mesh.vertices.size(), kEmptySlot);
    const auto number = [&](std::uint32_t index) {
      if (numbers[index] == kEmptySlot) {
        const SourceVertex& v = mesh.vertices[index];
        const bool negative = (v.tangent.w < 0) != mirrored;
        numbers[index] = vertices_.number({canonical(glm::vec3(place(instance, v.position) - out_.origin)),
                                           pack_normal(direction(normals, v.normal)),
                                           pack_tangent(direction(linear, glm::vec3(v.tangent)), negative),
                                           v.uv + glm::vec2(0.0F)});
      }
      return numbers[index];
    };
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      std::uint32_t a = number(mesh.indices[i]);
      std::uint32_t b = number(mesh.indices[i + 1]);
      const std::uint32_t c = number(mesh.indices[i + 2]);
      if (mirrored) std::swap(a, b);
      if (degenerate(a, b, c)) {
        ++out_.degenerate_triangles;
        continue;
      }
      out_.indices.insert(out_.indices.end(), {a, b, c});
      out_.materials.push_back(mesh.material);
      out_.objects.push_back(instance.object);
    }
  }

 private:
  [[nodiscard]] bool degenerate(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const glm::vec3 pa = out_.vertices[a].position;
    const glm::dvec3 ab(out_.vertices[b].position - pa);
    const glm::dvec3 ac(out_.vertices[c].position - pa);
    return glm::length(glm::cross(ab, ac)) == 0.0;
  }

  FlatMesh& out_;
  Deduplicator<ShadingVertex> vertices_;
};

}  // namespace

Result<FlatMesh> flatten(const SceneSource& source) {
  const auto bounds = bounds_of(source);
  if (bounds.has_error()) return bounds.error();
  FlatMesh out;
  out.origin = 0.5 * (bounds->low + bounds->high);
  out.box = {glm::vec3(bounds->low - out.origin), glm::vec3(bounds->high - out.origin)};
  std::size_t expected = 0;
  for (const SourceInstance& instance : source.instances)
    expected += source.meshes[instance.mesh].vertices.size();
  Flattener flattener(out, expected);
  for (const SourceInstance& instance : source.instances)
    flattener.add(source.meshes[instance.mesh], instance);
  if (out.indices.empty()) return Error{SceneError::kEmpty, source.name + ": every triangle is degenerate"};
  return out;
}

std::vector<VertexId> weld(const std::vector<ShadingVertex>& vertices, std::vector<glm::vec3>& positions) {
  Deduplicator<glm::vec3> points(positions, vertices.size());
  std::vector<VertexId> out;
  out.reserve(vertices.size());
  for (const ShadingVertex& v : vertices) out.push_back(static_cast<VertexId>(points.number(v.position)));
  return out;
}

}  // namespace atlaswire::render
