#pragma once

#include "render/camera.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace atlaswire::render {

/// How pixels of one pinhole view lie in another. A point seen at pixel (x, y) of the first view, at inverse
/// distance w (1/metres along that view's axis, 0: infinitely far), has in the second view the homogeneous
/// pixel h = homography (x, y, 1) + w parallax: it lies at pixel h.xy / h.z where h.z > 0 (else it is behind
/// the viewer), at inverse distance w / h.z. Pixels count from the top left corner; centres are at halves.
///
/// h is linear in (x, y, w), and so is w in (x, y) on any plane of the scene: triangles between pixels that
/// are interpolated in h are flat in space.
struct PixelTransfer {
  glm::dmat3 homography{1.0};  ///< of the rotation and the two lenses
  glm::dvec3 parallax{0.0};    ///< of the translation
};

PixelTransfer pixel_transfer(const Camera& from, const Camera& to);

}  // namespace atlaswire::render
