#include "render/passes/moved_id_mesh.h"

#include <utility>

namespace atlaswire::render {

namespace {

std::size_t most_bytes(const Scene& scene, const IdMesh& mesh) {
  std::size_t bytes = 0;
  for (const MovingPart& part : scene.motion->parts) bytes += part.positions.count * sizeof(glm::vec3);
  for (const IdMeshPart& part : mesh.parts)
    bytes += part.sources.size() * (part.cut ? sizeof(CutVertex) : sizeof(IdVertex));
  return bytes;
}

template <class Vertex>
std::vector<Vertex> run_of(const std::vector<Vertex>& all, std::uint32_t first, std::size_t count) {
  const auto begin = all.begin() + first;
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace

MovedIdMesh::MovedIdMesh(const Device& device, const Scene& scene)
    : MovedIdMesh(device, scene, make_id_mesh(scene)) {}

MovedIdMesh::MovedIdMesh(const Device& device, const Scene& scene, IdMesh mesh)
    : staging_(device, "moved id vertices", most_bytes(scene, mesh)) {
  for (IdMeshPart& part : mesh.parts) {
    Part& mine = parts_.emplace_back();
    mine.first = part.first;
    mine.sources = std::move(part.sources);
    if (part.cut) {
      mine.cut = run_of(mesh.cut, part.first, mine.sources.size());
    } else {
      mine.solid = run_of(mesh.solid, part.first, mine.sources.size());
    }
  }
}

void MovedIdMesh::record(const vk::raii::CommandBuffer& commands, const MovedScene& moved,
                         const VisibilityGeometry& geometry) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& mine = parts_[i];
    if (mine.version == moved.version(i)) continue;
    mine.version = moved.version(i);
    const std::span<const glm::vec3> positions = moved.positions(i);
    const std::span<const ShadingVertex> vertices = moved.vertices(i);
    for (std::size_t v = 0; v < mine.solid.size(); ++v) mine.solid[v].position = positions[mine.sources[v]];
    for (std::size_t v = 0; v < mine.cut.size(); ++v)
      mine.cut[v].position = vertices[mine.sources[v]].position;
    staging_.add(std::as_bytes(positions), geometry.positions,
                 moved.parts()[i].positions.first * sizeof(glm::vec3));
    staging_.add(std::as_bytes(std::span(mine.solid)), geometry.solid, mine.first * sizeof(IdVertex));
    staging_.add(std::as_bytes(std::span(mine.cut)), geometry.cut, mine.first * sizeof(CutVertex));
  }
  staging_.record(commands);
}

}  // namespace atlaswire::render
