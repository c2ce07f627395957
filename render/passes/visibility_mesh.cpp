#include "render/passes/visibility_mesh.h"

#include "render/passes/visibility_draws.h"
#include "render/scene/scene_motion.h"

#include <algorithm>
#include <array>
#include <span>

namespace atlaswire::render {
namespace {

constexpr std::uint32_t kNone = ~0U;

/// Makes one kind of vertices from numbered sources.
template <class Vertex>
class VertexStream {
 public:
  VertexStream(std::vector<Vertex>& out, std::size_t sources) : out_(&out), first_copy_(sources, kNone) {}

  /// Of each vertex made.
  [[nodiscard]] const std::vector<std::uint32_t>& sources() const { return sources_; }

  /// The vertex that any triangle may use.
  std::uint32_t use(std::uint32_t source, const Vertex& vertex) {
    std::uint32_t& copy = first_copy_[source];
    if (copy == kNone) copy = append(source, vertex, kNone);
    return copy;
  }
  /// Does its first copy lead no patch yet?
  [[nodiscard]] bool is_free(std::uint32_t source) const {
    return first_copy_[source] == kNone || (*out_)[first_copy_[source]].patch == kNone;
  }
  /// A vertex that leads `patch`: the first copy if that is free, else a new one.
  std::uint32_t lead(std::uint32_t source, const Vertex& vertex, std::uint32_t patch) {
    if (!is_free(source)) return append(source, vertex, patch);
    const std::uint32_t copy = use(source, vertex);
    (*out_)[copy].patch = patch;
    return copy;
  }

 private:
  std::uint32_t append(std::uint32_t source, Vertex vertex, std::uint32_t patch) {
    vertex.patch = patch;
    out_->push_back(vertex);
    sources_.push_back(source);
    return static_cast<std::uint32_t>(out_->size() - 1);
  }

  std::vector<Vertex>* out_;
  std::vector<std::uint32_t> first_copy_;  ///< by source
  std::vector<std::uint32_t> sources_;
};

/// The corners that belong to every triangle of a patch (base/patch_layout.h).
std::span<const std::uint8_t> common_corners(std::uint32_t triangles) {
  static constexpr std::array<std::uint8_t, 3> kOne{0, 1, 2};
  static constexpr std::array<std::uint8_t, 2> kTwo{0, 2};
  static constexpr std::array<std::uint8_t, 1> kThree{3};
  if (triangles == 1) return kOne;
  if (triangles == 2) return kTwo;
  return kThree;
}

/// Appends a patch's triangles, each turned so that the leading corner comes first. `source` numbers a
/// corner's vertex and `make` makes it.
template <class Vertex, class Source, class Make>
void append_patch(VertexStream<Vertex>& stream, std::vector<std::uint32_t>& indices, std::uint32_t patch,
                  std::uint32_t triangles, const Source& source, const Make& make) {
  const auto candidates = common_corners(triangles);
  auto leader = std::ranges::find_if(candidates, [&](std::uint8_t c) { return stream.is_free(source(c)); });
  if (leader == candidates.end()) leader = candidates.begin();
  const std::uint32_t first = stream.lead(source(*leader), make(*leader), patch);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    auto corners = patch_triangle(triangles, t);
    std::ranges::rotate(corners, std::ranges::find(corners, *leader));
    indices.push_back(first);
    for (const std::uint8_t c : {corners[1], corners[2]}) indices.push_back(stream.use(source(c), make(c)));
  }
}

/// Notes which vertices were made for which moving part: its patches are drawn at the places that are their
/// numbers, in some order, and nobody else uses their sources.
class PartLister {
 public:
  PartLister(const Scene& scene, IdMesh& mesh) : scene_(&scene), mesh_(&mesh) {
    if (scene.motion) parts_ = scene.motion->parts;
  }

  void begin_patch(std::uint32_t drawn, const Patch& patch) {
    if (at_ == parts_.size() || drawn != parts_[at_].mover.first_patch) return;
    IdMeshPart& part = mesh_->parts.emplace_back();
    part.cut = id_class(scene_->materials[patch.material]) != IdClass::kOpaque;
    part.first = static_cast<std::uint32_t>(part.cut ? mesh_->cut.size() : mesh_->solid.size());
  }
  void end_patch(std::uint32_t drawn, const std::vector<std::uint32_t>& solid,
                 const std::vector<std::uint32_t>& cut) {
    if (at_ == parts_.size() || drawn + 1 != parts_[at_].mover.end()) return;
    IdMeshPart& part = mesh_->parts.back();
    const std::uint32_t first = part.cut ? parts_[at_].vertices.first : parts_[at_].positions.first;
    for (const std::uint32_t source : std::span(part.cut ? cut : solid).subspan(part.first))
      part.sources.push_back(source - first);
    ++at_;
  }

 private:
  const Scene* scene_;
  IdMesh* mesh_;
  std::span<const MovingPart> parts_;
  std::size_t at_ = 0;
};

}  // namespace

IdMesh make_id_mesh(const Scene& scene) {
  IdMesh mesh;
  mesh.indices.reserve(scene.indices.size());
  VertexStream<IdVertex> solid(mesh.solid, scene.positions.size());
  VertexStream<CutVertex> cut(mesh.cut, scene.vertices.size());
  PartLister parts(scene, mesh);
  for (std::uint32_t drawn = 0; drawn < scene.drawn.size(); ++drawn) {
    const std::uint32_t i = scene.drawn[drawn];
    const Patch& patch = scene.patches[i];
    parts.begin_patch(drawn, patch);
    if (id_class(scene.materials[patch.material]) == IdClass::kOpaque) {
      const auto source = [&](std::uint8_t corner) { return value(patch.positions[corner]); };
      const auto make = [&](std::uint8_t corner) { return IdVertex{scene.positions[source(corner)], kNone}; };
      append_patch(solid, mesh.indices, i, patch.triangles, source, make);
    } else {
      const auto source = [&](std::uint8_t corner) { return patch.vertices[corner]; };
      const auto make = [&](std::uint8_t corner) {
        const ShadingVertex& vertex = scene.vertices[source(corner)];
        return CutVertex{vertex.position, kNone, vertex.uv};
      };
      append_patch(cut, mesh.indices, i, patch.triangles, source, make);
    }
    parts.end_patch(drawn, solid.sources(), cut.sources());
  }
  return mesh;
}

}  // namespace atlaswire::render
