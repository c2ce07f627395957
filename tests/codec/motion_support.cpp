#include "tests/codec/motion_support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace atlaswire::codec {

WavingSheet::WavingSheet(std::uint32_t side) : side_(side) {
  for (const glm::dvec3& p : at(0)) surface_.add(settings().grid.quantize(p));
  for (std::uint32_t row = 0; row + 1 < side; ++row) {
    for (std::uint32_t column = 0; column + 1 < side; ++column) {
      const std::uint32_t corner = row * side + column;
      surface_.connect_around(std::array{corner, corner + 1, corner + side});
      surface_.connect_around(std::array{corner + 1, corner + side + 1, corner + side});
    }
  }
  all_.resize(surface_.size());
  std::iota(all_.begin(), all_.end(), 0U);
}

MotionSettings WavingSheet::settings() {
  MotionSettings settings;
  settings.grid = PositionGrid::over(glm::dvec3(-2.0), glm::dvec3(2.0), 16);
  return settings;
}

std::vector<glm::dvec3> WavingSheet::at(double seconds) const {
  std::vector<glm::dvec3> out;
  out.reserve(std::size_t{side_} * side_);
  const double last = std::max(1.0, side_ - 1.0);
  for (std::uint32_t row = 0; row < side_; ++row) {
    for (std::uint32_t column = 0; column < side_; ++column) {
      const glm::dvec2 p(column / last - 0.5, row / last - 0.5);
      const double phase = 7.0 * p.x + 2.0 * p.y - 5.0 * seconds;
      out.emplace_back(p.x + 0.02 * std::sin(0.7 * phase), p.y, 0.12 * (p.x + 0.5) * std::sin(phase));
    }
  }
  return out;
}

RigidTransform orbit(double radius, double seconds) {
  return {.translation = radius * glm::dvec3(std::cos(seconds) - 1.0, 0.1 * seconds, std::sin(seconds)),
          .orientation = glm::angleAxis(1.7 * seconds, glm::normalize(glm::dvec3(1, 2, 0.5)))};
}

ByteBuffer MotionStream::pass(const MotionScope& scope, const MotionTargets& targets) {
  ByteBuffer message;
  const auto told = encoder.encode(scope, targets, message);
  EXPECT_TRUE(told) << told.error().message();
  const auto heard = decoder.decode(scope, message);
  EXPECT_TRUE(heard) << heard.error().message();
  if (!told || !heard) return message;
  double position_error = 0;
  for (std::size_t i = 0; i < scope.vertices.size(); ++i) {
    const glm::dvec3 shown = decoder.position(*scope.surface, scope.vertices[i]);
    position_error = std::max(position_error, glm::distance(shown, targets.positions[i]));
  }
  EXPECT_LE(position_error, settings_.grid.max_error() * (1 + 1e-9));
  for (std::size_t i = 0; i < scope.objects.size(); ++i) {
    const RigidTransform shown = decoder.transform(scope.objects[i]);
    const RigidTransform& wanted = targets.transforms[i];
    EXPECT_LE(glm::distance(shown.translation, wanted.translation),
              settings_.transforms.max_translation_error() * (1 + 1e-9));
    const glm::dquat between = glm::inverse(glm::normalize(wanted.orientation)) * shown.orientation;
    const double angle =
        2 * std::atan2(glm::length(glm::dvec3(between.x, between.y, between.z)), std::abs(between.w));
    EXPECT_LE(angle, settings_.transforms.max_rotation_error());
  }
  return message;
}

}  // namespace atlaswire::codec
