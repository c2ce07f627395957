#pragma once

#include "codec/motion_surface.h"
#include "render/scene/animator.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace atlaswire::bench {

/// The deformed instances of a moving scene as one surface on a grid: equal rest points of an instance are
/// one vertex, as a receiver of geometry has them.
class MovingSurface {
 public:
  /// Borrows the source. `grid` should hold all that its clips reach.
  MovingSurface(const render::SceneSource& source, const PositionGrid& grid);

  [[nodiscard]] const codec::MotionSurface& surface() const { return surface_; }
  /// All its vertices.
  [[nodiscard]] const std::vector<std::uint32_t>& all() const { return all_; }
  /// Where they are, as the animator is posed: metres.
  void positions(const render::Animator& animator, std::vector<glm::dvec3>& out);

 private:
  struct Part {
    std::uint32_t instance = 0;
    std::vector<std::uint32_t> from;  ///< for each of its vertices on the surface, one of the mesh's
  };
  codec::MotionSurface surface_;
  std::vector<std::uint32_t> all_;
  std::vector<Part> parts_;
  std::vector<glm::dvec3> scratch_;
};

}  // namespace atlaswire::bench
