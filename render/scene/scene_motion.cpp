#include "render/scene/scene_motion.h"

#include "base/assert.h"
#include "base/patch_layout.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace atlaswire::render {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Numbers from the lowest to the highest that were taken in.
class Span {
 public:
  void take_in(std::uint32_t number) {
    low_ = std::min(low_, number);
    high_ = std::max(high_, number);
  }
  [[nodiscard]] NumberRange range() const { return {low_, high_ - low_ + 1}; }

 private:
  std::uint32_t low_ = kNone;
  std::uint32_t high_ = 0;
};

MovingPart list_part(const Scene& scene, std::uint32_t first, std::uint32_t end,
                     std::span<const std::uint32_t> sources, bool deforms) {
  MovingPart part;
  part.mover = {.first_patch = first, .patch_count = end - first, .deforms = deforms};
  Span vertices;
  Span positions;
  for (std::uint32_t p = first; p < end; ++p) {
    const Patch& patch = scene.patches[p];
    part.triangles.count += patch.triangles;
    for (std::size_t c = 0; c < kMaxPatchCorners; ++c) {
      vertices.take_in(patch.vertices[c]);
      positions.take_in(value(patch.positions[c]));
    }
  }
  part.vertices = vertices.range();
  part.positions = positions.range();
  part.points.assign(part.vertices.count, kNone);
  if (deforms) part.sources.resize(part.positions.count);
  for (std::uint32_t p = first; p < end; ++p) {
    const Patch& patch = scene.patches[p];
    for (std::size_t c = 0; c < kMaxPatchCorners; ++c) {
      const std::uint32_t point = value(patch.positions[c]) - part.positions.first;
      part.points[patch.vertices[c] - part.vertices.first] = point;
      if (deforms) part.sources[point] = sources[patch.vertices[c]];
    }
  }
  return part;
}

/// Only what an animator needs of it.
void thin_out(SceneSource& source, std::span<const InstanceMotion> motions) {
  std::vector<bool> keeps(source.meshes.size(), false);
  for (std::size_t i = 0; i < source.instances.size(); ++i) {
    if (motions[i] == InstanceMotion::kDeforms) keeps[source.instances[i].mesh] = true;
  }
  for (std::size_t m = 0; m < source.meshes.size(); ++m) {
    source.meshes[m].indices = {};
    if (!keeps[m]) source.meshes[m].vertices = {};
  }
  source.materials = {};
  source.objects = {};
  source.textures = {};
  source.lights = {};
}

}  // namespace

std::shared_ptr<const SceneMotion> list_motion(const Scene& scene, std::span<const std::uint32_t> instances,
                                               std::span<const std::uint32_t> sources,
                                               std::span<const InstanceMotion> motions, SceneSource source) {
  auto motion = std::make_shared<SceneMotion>();
  std::map<std::uint32_t, std::uint32_t> objects;  // by node
  std::uint32_t chunk = 0;
  std::uint32_t triangle = 0;
  for (std::uint32_t p = 0; p < instances.size();) {
    std::uint32_t end = p + 1;
    while (end < instances.size() && instances[end] == instances[p]) ++end;
    std::uint32_t triangles = 0;
    for (std::uint32_t i = p; i < end; ++i) triangles += scene.patches[i].triangles;
    if (instances[p] != 0) {
      const std::uint32_t instance = instances[p] - 1;
      MovingPart part = list_part(scene, p, end, sources, motions[instance] == InstanceMotion::kDeforms);
      part.instance = instance;
      part.triangles.first = triangle;
      while (scene.chunks[chunk].first_patch < p) ++chunk;
      part.chunks.first = chunk;
      while (chunk < scene.chunks.size() && scene.chunks[chunk].first_patch < end) ++chunk;
      part.chunks.count = chunk - part.chunks.first;
      if (!part.mover.deforms) {
        const std::uint32_t node = source.rig.instances[instance].node;
        const auto [object, is_new] =
            objects.try_emplace(node, static_cast<std::uint32_t>(motion->objects.size()));
        if (is_new) motion->objects.push_back(instance);
        part.mover.object = object->second;
      }
      motion->parts.push_back(std::move(part));
    }
    triangle += triangles;
    p = end;
  }
  if (motion->parts.empty()) return nullptr;
  AW_ASSERT(motion->parts.size() <= kMostMovers);
  thin_out(source, motions);
  motion->source = std::move(source);
  return motion;
}

}  // namespace atlaswire::render
