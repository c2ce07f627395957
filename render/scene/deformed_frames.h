#pragma once

#include "render/scene/scene.h"

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace atlaswire::render {

/// Turns the normals and tangents of a surface as it deforms. Each point has a frame: the normal of the
/// triangles around it, weighted by area, and an edge; what turns the frame at rest to the frame now turns
/// what the file said at rest. So seams, hard edges and authored normals stay what they are, whatever
/// deformed the surface. Where a frame collapses, vertices keep their directions at rest.
class DeformedFrames {
 public:
  using Triangle = std::array<std::uint32_t, 3>;  ///< points

  DeformedFrames(std::vector<Triangle> triangles, std::span<const glm::vec3> rest);

  /// Writes normals and tangents. `points[i]`: the point of vertex i; `rest` and `out` by vertex.
  void turn(std::span<const glm::vec3> positions, std::span<const std::uint32_t> points,
            std::span<const ShadingVertex> rest, std::span<ShadingVertex> out);

 private:
  void find_frames(std::span<const glm::vec3> positions, std::vector<glm::mat3>& frames);

  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> along_;  ///< by point: where its edge leads
  std::vector<glm::vec3> normals_;
  std::vector<glm::mat3> rest_;  ///< zero: none
  std::vector<glm::mat3> now_;
};

}  // namespace atlaswire::render
