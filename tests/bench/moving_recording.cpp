#include "tests/bench/moving_recording.h"

#include "codec/mover_scope.h"
#include "codec/mover_watch.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace atlaswire::bench {

namespace {

constexpr std::uint32_t kQuads = 20;
constexpr std::uint32_t kTurner = 30;
constexpr std::uint32_t kResting = 40;

codec::AddedPatch quad(std::uint32_t id, std::uint32_t first_vertex) {
  codec::AddedPatch patch{.id = PatchId{id}, .triangles = 2};
  for (std::uint32_t c = 0; c < 4; ++c) patch.corners[c] = VertexId{first_vertex + c};
  patch.block = {.x = static_cast<std::uint16_t>(8 * (id % 8)),
                 .y = static_cast<std::uint16_t>(8 * (id / 8)),
                 .width_log2 = 3,
                 .height_log2 = 2};
  return patch;
}

codec::MetaUpdate update_of(std::uint32_t frame) {
  const bool anew = frame == 0 || frame == 10;
  codec::MetaUpdate update{.frame = FrameId{frame}, .reset = anew};
  update.cue = codec::LayoutCue{.reset = frame == 3, .check = static_cast<std::uint16_t>(1000 + frame)};
  if (anew) {
    for (std::uint32_t v = 0; v < 2 * kQuads + 10; ++v)
      update.vertices.push_back({VertexId{v}, {1000 + 500 * (v / 2), 400 * (v % 2), 7 * v}});
    for (std::uint32_t p = 0; p < kQuads; ++p) update.added.push_back(quad(p, 2 * p));
    update.added.push_back(quad(kTurner, 2 * kQuads + 2));
    update.added.push_back(quad(kResting, 2 * kQuads + 6));
  }
  if (frame == 4) {
    for (std::uint32_t p = 0; p < kQuads / 2; ++p) update.removed.push_back(PatchId{p});
    update.removed.push_back(PatchId{kTurner});
  }
  if (frame == 7) {
    for (std::uint32_t p = 0; p < kQuads / 2; ++p) update.added.push_back(quad(p, 2 * p));
    update.added.push_back(quad(kTurner, 2 * kQuads + 2));
    update.moved.push_back({PatchId{kResting}, quad(kResting + 1, 0).block});
  }
  return update;
}

MoverPlaces places_of(const codec::MoverScope& scope, const PositionGrid& grid, double seconds) {
  MoverPlaces places;
  for (const std::uint32_t vertex : scope.scope().vertices) {
    glm::dvec3 at = grid.position(scope.surface().rest(vertex));
    at.z += 0.5 * std::sin(3 * seconds + at.x);
    places.positions.push_back(at);
  }
  for ([[maybe_unused]] const std::uint32_t object : scope.scope().objects)
    places.transforms.push_back({{0.1 * seconds, 0, 0}, glm::angleAxis(seconds, glm::dvec3(0, 1, 0))});
  return places;
}

}  // namespace

MetaRecording moving_recording(std::uint32_t frames) {
  MetaRecording recording;
  recording.limits.max_vertices = 100;
  recording.limits.max_patches = 50;
  recording.limits.atlas = {256, 256};
  recording.memory = {.superblock_log2 = 5, .min_block_log2 = 2, .high_water = 0.75};
  RecordedMotion& motion = recording.motion.emplace();
  motion.settings.grid = {.origin = {-8, -8, -8}, .step = 1e-3, .bits = 16};
  motion.settings.transforms = {.step = 1e-3, .rotation_bits = 12};
  motion.movers = {{0, kQuads, true, 0}, {kTurner, 1, false, 0}};
  codec::MoverWatch watch(motion.movers);
  codec::MoverScope scope(motion.movers, 1);
  for (std::uint32_t frame = 0; frame < frames; ++frame) {
    recording.updates.push_back(update_of(frame));
    scope.follow(watch.take(recording.updates.back()));
    motion.frames.push_back(places_of(scope, motion.settings.grid, frame / 30.0));
  }
  return recording;
}

}  // namespace atlaswire::bench
