#include "base/pose.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace atlaswire {

namespace {

bool within(const glm::dvec3& v, double limit) {
  return std::abs(v.x) <= limit && std::abs(v.y) <= limit && std::abs(v.z) <= limit;  // false for NaN
}

}  // namespace

Pose extrapolate(const Pose& pose, Duration ahead) {
  const double seconds = to_seconds(ahead);
  Pose out = pose;
  out.position += pose.velocity * seconds;
  const double speed = glm::length(pose.angular_velocity);
  if (speed > 0) {
    const double half = 0.5 * speed * seconds;
    const glm::dvec3 axis = pose.angular_velocity / speed;
    const glm::dquat turn(std::cos(half), axis * std::sin(half));
    out.orientation = glm::normalize(turn * pose.orientation);
  }
  return out;
}

Pose interpolate(const Pose& a, const Pose& b, double t) {
  Pose out;
  out.position = a.position + (b.position - a.position) * t;
  out.orientation = glm::normalize(glm::slerp(a.orientation, b.orientation, t));
  out.velocity = a.velocity + (b.velocity - a.velocity) * t;
  out.angular_velocity = a.angular_velocity + (b.angular_velocity - a.angular_velocity) * t;
  return out;
}

void set_velocities_from(const Pose& a, Pose& b, Duration elapsed) {
  b.velocity = glm::dvec3(0.0);
  b.angular_velocity = glm::dvec3(0.0);
  const double seconds = to_seconds(elapsed);
  if (!(seconds > 0)) return;
  b.velocity = (b.position - a.position) / seconds;
  glm::dquat turn = b.orientation * glm::conjugate(a.orientation);
  if (turn.w < 0) turn = -turn;
  const glm::dvec3 axis(turn.x, turn.y, turn.z);
  const double sine = glm::length(axis);
  if (sine > 0) b.angular_velocity = axis * (2 * std::atan2(sine, turn.w) / (sine * seconds));
}

bool is_sane(const Pose& pose) {
  constexpr double kMaxPosition = 1e9;
  constexpr double kMaxVelocity = 1e4;
  const auto& q = pose.orientation;
  const double norm = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return within(pose.position, kMaxPosition) && std::abs(norm - 1) <= 2e-3 &&
         within(pose.velocity, kMaxVelocity) && within(pose.angular_velocity, kMaxVelocity);
}

}  // namespace atlaswire
