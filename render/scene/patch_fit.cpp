#include "render/scene/patch_fit.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace atlaswire::render {
namespace {

constexpr double kRight = std::numbers::pi / 2;

double fit_of(double deviation) { return std::clamp(1.0 - deviation / (4 * kRight), 0.0, 1.0); }

}  // namespace

double bend(const glm::vec3& normal_a, const glm::vec3& normal_b) {
  return std::atan2(static_cast<double>(glm::length(glm::cross(normal_a, normal_b))),
                    static_cast<double>(glm::dot(normal_a, normal_b)));
}

double corner_angle(const glm::vec3& at, const glm::vec3& a, const glm::vec3& b) {
  return bend(a - at, b - at);
}

double quad_fit(const std::array<glm::vec3, 4>& p) {
  const double at0 = corner_angle(p[0], p[1], p[2]) + corner_angle(p[0], p[2], p[3]);
  const double at2 = corner_angle(p[2], p[0], p[1]) + corner_angle(p[2], p[3], p[0]);
  const double at1 = corner_angle(p[1], p[2], p[0]);
  const double at3 = corner_angle(p[3], p[0], p[2]);
  return fit_of(std::abs(at0 - kRight) + std::abs(at1 - kRight) + std::abs(at2 - kRight) +
                std::abs(at3 - kRight));
}

double fan_fit(const std::array<glm::vec3, 5>& p) {
  const double at0 = corner_angle(p[0], p[1], p[3]) + corner_angle(p[0], p[3], p[4]);
  const double at1 = corner_angle(p[1], p[3], p[0]) + corner_angle(p[1], p[2], p[3]);
  const double at2 = corner_angle(p[2], p[3], p[1]);
  const double at3 =
      corner_angle(p[3], p[0], p[1]) + corner_angle(p[3], p[1], p[2]) + corner_angle(p[3], p[4], p[0]);
  const double at4 = corner_angle(p[4], p[0], p[3]);
  return fit_of(std::abs(at0 - kRight) + std::abs(at1 - kRight) + std::abs(at2 - kRight) +
                std::abs(at4 - kRight) + std::abs(at3 - 2 * kRight));
}

}  // namespace atlaswire::render
