#pragma once

#include <array>
#include <glm/vec3.hpp>

namespace atlaswire::render {

/// How well two triangles fill a rectangle, 0..1: 1 - (sum of |corner angle - 90 degrees|) / 360 degrees over
/// the four corners of the quad unfolded at its diagonal. A square gives 1, a 60-degree rhombus 2/3, two
/// triangles that make one larger triangle about 1/2. `corners` in patch_layout order.
double quad_fit(const std::array<glm::vec3, 4>& corners);

/// The same for three triangles in a fan around corner 3, whose angle should be 180 degrees.
double fan_fit(const std::array<glm::vec3, 5>& corners);

/// Radians between the planes of two triangles given by their (unnormalised) normals, 0..pi.
double bend(const glm::vec3& normal_a, const glm::vec3& normal_b);

/// Radians at `at` between the ways to `a` and `b`.
double corner_angle(const glm::vec3& at, const glm::vec3& a, const glm::vec3& b);

}  // namespace atlaswire::render
