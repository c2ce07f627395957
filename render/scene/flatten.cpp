#include "render/scene/flatten.h"

#include "render/scene/scene_error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numeric>
#include <utility>

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
    // Not every value need have been numbered here.
    std::vector<std::uint32_t> wider(slots_.size() * 2, kEmptySlot);
    for (const std::uint32_t i : slots_) {
      if (i == kEmptySlot) continue;
      std::size_t slot = hash(values_[i]) & (wider.size() - 1);
      while (wider[slot] != kEmptySlot) slot = (slot + 1) & (wider.size() - 1);
      wider[slot] = i;
    }
    slots_ = std::move(wider);
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

/// A vertex of what moves: two are one only if they move alike.
struct MovingVertex {
  ShadingVertex vertex;
  std::uint32_t rig = 0;
};
static_assert(sizeof(MovingVertex) == 32);

/// Entries of a rig that say the same, by the number of one of them.
std::vector<std::uint32_t> equal_rigs(const RigMesh& rig) {
  const std::size_t count =
      rig.joints.empty() ? rig.morphs.empty() ? 0 : rig.morphs[0].size() : rig.joints.size();
  const auto compare = [&](std::uint32_t a, std::uint32_t b) {
    if (!rig.joints.empty()) {
      if (rig.joints[a] != rig.joints[b]) return rig.joints[a] < rig.joints[b] ? -1 : 1;
      if (rig.weights[a] != rig.weights[b]) return rig.weights[a] < rig.weights[b] ? -1 : 1;
    }
    for (const std::vector<glm::vec3>& morph : rig.morphs) {
      for (int axis = 0; axis < 3; ++axis) {
        if (morph[a][axis] != morph[b][axis]) return morph[a][axis] < morph[b][axis] ? -1 : 1;
      }
    }
    return 0;
  };
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) { return compare(a, b) < 0; });
  std::vector<std::uint32_t> same(count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool repeats = i > 0 && compare(order[i - 1], order[i]) == 0;
    same[order[i]] = repeats ? same[order[i - 1]] : order[i];
  }
  return same;
}

class Flattener {
 public:
  Flattener(FlatMesh& out, std::size_t expected) : out_(out), vertices_(out.vertices, expected) {}

  void add(const SourceMesh& mesh, const SourceInstance& instance) {
    place_all(mesh, instance, [this](const ShadingVertex& v, std::uint32_t) { return vertices_.number(v); });
  }

  /// An instance whose vertices are its own alone. `number`: 1 + that of the instance.
  void add_moving(const SourceMesh& mesh, const SourceInstance& instance, const RigMesh* rig,
                  std::uint32_t number) {
    const auto first = static_cast<std::uint32_t>(out_.vertices.size());
    const std::size_t first_triangle = out_.materials.size();
    std::vector<MovingVertex> own;
    Deduplicator<MovingVertex> numbers(own, mesh.vertices.size());
    const std::vector<std::uint32_t> same = rig == nullptr ? std::vector<std::uint32_t>{} : equal_rigs(*rig);
    out_.origins.resize(first);
    place_all(mesh, instance, [&](const ShadingVertex& v, std::uint32_t index) {
      const std::uint32_t entry = same.empty() ? 0 : same[mesh.vertices[index].rig];
      const std::uint32_t n = numbers.number({v, entry});
      if (first + n == out_.vertices.size()) {
        out_.vertices.push_back(v);
        out_.origins.push_back({number, index, aparts_ + entry});
      }
      return first + n;
    });
    aparts_ += static_cast<std::uint32_t>(std::max<std::size_t>(1, same.size()));
    out_.instances.resize(first_triangle);
    out_.instances.resize(out_.materials.size(), number);
  }

  void finish() {
    if (out_.instances.empty()) return;
    out_.origins.resize(out_.vertices.size());
    out_.instances.resize(out_.materials.size());
  }

 private:
  template <class Number>
  void place_all(const SourceMesh& mesh, const SourceInstance& instance, const Number& number_of) {
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
        numbers[index] = number_of(
            {canonical(glm::vec3(place(instance, v.position) - out_.origin)),
             pack_normal(direction(normals, v.normal)),
             pack_tangent(direction(linear, glm::vec3(v.tangent)), negative), v.uv + glm::vec2(0.0F)},
            index);
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

  [[nodiscard]] bool degenerate(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const glm::vec3 pa = out_.vertices[a].position;
    const glm::dvec3 ab(out_.vertices[b].position - pa);
    const glm::dvec3 ac(out_.vertices[c].position - pa);
    return glm::length(glm::cross(ab, ac)) == 0.0;
  }

  FlatMesh& out_;
  Deduplicator<ShadingVertex> vertices_;
  std::uint32_t aparts_ = 1;  ///< 0: what rests
};

}  // namespace

Result<FlatMesh> flatten(const SceneSource& source, std::span<const InstanceMotion> motions) {
  const auto bounds = bounds_of(source);
  if (bounds.has_error()) return bounds.error();
  FlatMesh out;
  out.origin = 0.5 * (bounds->low + bounds->high);
  out.box = {glm::vec3(bounds->low - out.origin), glm::vec3(bounds->high - out.origin)};
  std::size_t expected = 0;
  for (const SourceInstance& instance : source.instances)
    expected += source.meshes[instance.mesh].vertices.size();
  Flattener flattener(out, expected);
  for (std::uint32_t i = 0; i < source.instances.size(); ++i) {
    const SourceInstance& instance = source.instances[i];
    const SourceMesh& mesh = source.meshes[instance.mesh];
    if (motions[i] == InstanceMotion::kRests) {
      flattener.add(mesh, instance);
    } else {
      const bool deforms = motions[i] == InstanceMotion::kDeforms;
      flattener.add_moving(mesh, instance, deforms ? &source.rig.meshes[instance.mesh] : nullptr, i + 1);
    }
  }
  flattener.finish();
  if (out.indices.empty()) return Error{SceneError::kEmpty, source.name + ": every triangle is degenerate"};
  return out;
}

namespace {

struct Point {
  glm::vec3 position;
  std::uint32_t apart = 0;
};
static_assert(sizeof(Point) == 16);

}  // namespace

std::vector<VertexId> weld(const std::vector<ShadingVertex>& vertices, std::span<const VertexOrigin> origins,
                           std::vector<glm::vec3>& positions) {
  std::vector<Point> points;
  Deduplicator<Point> numbers(points, vertices.size());
  std::vector<VertexId> out;
  out.reserve(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const std::uint32_t apart = origins.empty() ? 0 : origins[i].apart;
    out.push_back(static_cast<VertexId>(numbers.number({vertices[i].position, apart})));
  }
  positions.reserve(points.size());
  for (const Point& point : points) positions.push_back(point.position);
  return out;
}

}  // namespace atlaswire::render
