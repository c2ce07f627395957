#include "server/motion_teller.h"

#include "base/assert.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace atlaswire::server {

namespace {

/// So fine that no point of an object is farther off than the grid's own error: an orientation errs by at
/// most 4 * 2^-bits radians.
std::uint32_t suited_rotation_bits(double radius, double error) {
  constexpr std::uint32_t kFewest = 10;
  constexpr std::uint32_t kMost = 20;
  const double bits = std::ceil(std::log2(std::max(4 * radius / error, 1.0)));
  return static_cast<std::uint32_t>(std::clamp(bits, double{kFewest}, double{kMost}));
}

/// What the encoder takes: a grid's size beyond it on every side.
glm::dvec3 within_margins(const glm::dvec3& p, const PositionGrid& grid) {
  const double side = grid.step * static_cast<double>((1U << grid.bits) - 1);
  return glm::clamp(p, grid.origin - side, grid.origin + 2 * side);
}

codec::MotionSettings settings_of(const proto::MotionDescription& d, const PositionGrid& grid) {
  return {grid, {.step = d.translation_step, .rotation_bits = d.rotation_bits}};
}

constexpr std::uint64_t kSeed = 1;  // our own positions are not chosen against us

}  // namespace

proto::MotionDescription describe_motion(const render::Scene& scene, const PositionGrid& grid) {
  AW_ASSERT(scene.motion);
  const render::SceneMotion& motion = *scene.motion;
  const render::Animator animator(motion.source);
  proto::MotionDescription out;
  for (const std::uint32_t instance : motion.objects)
    out.pivots.push_back(grid.quantize(animator.pivot(instance)));
  double radius = 0;
  for (const render::MovingPart& part : motion.parts) {
    out.movers.push_back(part.mover);
    if (part.mover.deforms) continue;
    const glm::dvec3 pivot = grid.position(out.pivots[part.mover.object]) - scene.origin;
    for (std::uint32_t p = part.positions.first; p < part.positions.end(); ++p)
      radius = std::max(radius, glm::distance(glm::dvec3(scene.positions[p]), pivot));
  }
  out.translation_step = grid.step;
  out.rotation_bits = suited_rotation_bits(radius, grid.max_error());
  return out;
}

MotionTeller::MotionTeller(std::shared_ptr<const render::Scene> scene, const PositionGrid& grid)
    : scene_(std::move(scene)),
      grid_(grid),
      description_(describe_motion(*scene_, grid)),
      watch_(description_.movers),
      scope_(description_.movers, kSeed),
      encoder_(settings_of(description_, grid)) {
  std::uint32_t at = 0;
  for (const render::MovingPart& part : scene_->motion->parts) {
    if (!part.mover.deforms) continue;
    runs_.push_back({part.positions.first, at});
    at += part.positions.count;
  }
}

MovedFrame MotionTeller::look(const render::MovedScene& moved) const {
  MovedFrame frame;
  for (std::size_t i = 0; i < moved.parts().size(); ++i) {
    if (!moved.parts()[i].mover.deforms) continue;
    const auto positions = moved.positions(i);
    frame.points.insert(frame.points.end(), positions.begin(), positions.end());
  }
  frame.transforms.reserve(description_.pivots.size());
  for (std::size_t o = 0; o < description_.pivots.size(); ++o) {
    // About another pivot than the animator's: the translation takes the difference.
    const Pose& motion = moved.motion(o);
    const glm::dvec3 away = grid_.position(description_.pivots[o]) - moved.pivot(o);
    frame.transforms.push_back({motion.position + motion.orientation * away - away, motion.orientation});
  }
  return frame;
}

glm::dvec3 MotionTeller::place_of(VertexId id, const MovedFrame& moved) const {
  const auto after = std::ranges::upper_bound(runs_, value(id), {}, &Run::first);
  AW_ASSERT(after != runs_.begin());
  const Run& run = *std::prev(after);
  return within_margins(scene_->origin + glm::dvec3(moved.points[run.at + value(id) - run.first]), grid_);
}

Result<void> MotionTeller::tell(const codec::MetaUpdate& update, const MovedFrame& moved, ByteBuffer& out) {
  scope_.follow(watch_.take(update));
  const codec::MotionScope scope = scope_.scope();
  positions_.clear();
  for (const std::uint32_t vertex : scope.vertices) positions_.push_back(place_of(scope_.id(vertex), moved));
  transforms_.clear();
  for (const std::uint32_t object : scope.objects) transforms_.push_back(moved.transforms[object]);
  return encoder_.encode(scope, {update.reset, positions_, transforms_}, out);
}

}  // namespace atlaswire::server
