#include "bench/moving_surface.h"

#include <array>
#include <map>
#include <numeric>
#include <tuple>

namespace atlaswire::bench {

MovingSurface::MovingSurface(const render::SceneSource& source, const PositionGrid& grid) {
  const render::Animator animator(source);
  for (std::uint32_t i = 0; i < source.instances.size(); ++i) {
    if (!animator.deforms(i)) continue;
    const render::SourceMesh& mesh = source.meshes[source.instances[i].mesh];
    Part& part = parts_.emplace_back();
    part.instance = i;
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::uint32_t> known;
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      const GridPosition rest = grid.quantize(
          glm::dvec3(source.instances[i].to_scene * glm::dvec4(glm::dvec3(mesh.vertices[v].position), 1.0)));
      const auto [found, fresh] = known.try_emplace({rest.x, rest.y, rest.z}, surface_.size());
      if (fresh) {
        surface_.add(rest);
        part.from.push_back(v);
      }
      numbers.push_back(found->second);
    }
    for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
      surface_.connect_around(
          std::array{numbers[mesh.indices[t]], numbers[mesh.indices[t + 1]], numbers[mesh.indices[t + 2]]});
    }
  }
  all_.resize(surface_.size());
  std::iota(all_.begin(), all_.end(), 0U);
}

void MovingSurface::positions(const render::Animator& animator, std::vector<glm::dvec3>& out) {
  out.clear();
  for (const Part& part : parts_) {
    animator.positions(part.instance, scratch_);
    for (const std::uint32_t v : part.from) out.push_back(scratch_[v]);
  }
}

}  // namespace atlaswire::bench
