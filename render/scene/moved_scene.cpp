#include "render/scene/moved_scene.h"

#include "base/assert.h"
#include "base/patch_layout.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

namespace atlaswire::render {

namespace {

void grow(Box& box, const glm::vec3& p) {
  box.low = glm::min(box.low, p);
  box.high = glm::max(box.high, p);
}

Box box_of(const Scene& scene, const MovingPart& part, const Chunk& chunk,
           std::span<const glm::vec3> positions) {
  const auto at = [&](VertexId id) { return positions[value(id) - part.positions.first]; };
  const std::span<const std::uint32_t> patches = patches_of(scene, chunk);
  const glm::vec3 first = at(scene.patches[patches.front()].positions[0]);
  Box box{first, first};
  for (const std::uint32_t p : patches) {
    for (const VertexId id : scene.patches[p].positions) grow(box, at(id));
  }
  return box;
}

std::vector<DeformedFrames::Triangle> triangles_of(const Scene& scene, const MovingPart& part) {
  std::vector<DeformedFrames::Triangle> triangles;
  triangles.reserve(part.triangles.count);
  for (std::uint32_t t = part.triangles.first; t < part.triangles.end(); ++t) {
    DeformedFrames::Triangle& triangle = triangles.emplace_back();
    for (std::size_t c = 0; c < 3; ++c)
      triangle[c] = part.points[scene.indices[3 * std::size_t{t} + c] - part.vertices.first];
  }
  return triangles;
}

/// Nothing is farther from zero than what poses and grids may name.
constexpr double kFarthest = 1e9;

bool within_reach(const glm::dvec3& p) {
  return std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest;
}

/// A box relative to `origin`, cut to what is within reach.
Box reachable(const Box& box, const glm::dvec3& origin) {
  constexpr double kWithRounding = kFarthest * (1 - 1e-6);
  const glm::vec3 low(glm::dvec3(-kWithRounding) - origin);
  const glm::vec3 high(glm::dvec3(kWithRounding) - origin);
  return {glm::clamp(box.low, low, high), glm::clamp(box.high, low, high)};
}

template <class T>
std::span<const T> part_of(const std::vector<T>& all, const NumberRange& range) {
  return std::span(all).subspan(range.first, range.count);
}

}  // namespace

MovedScene::MovedScene(std::shared_ptr<const Scene> scene) : scene_(std::move(scene)) {
  boxes_.reserve(scene_->chunks.size());
  for (const Chunk& chunk : scene_->chunks) boxes_.push_back(chunk.box);
  if (!scene_->motion) return;
  const SceneMotion& motion = *scene_->motion;
  parts_ = motion.parts;
  animator_.emplace(motion.source);
  objects_.resize(motion.objects.size());
  for (std::size_t o = 0; o < objects_.size(); ++o) objects_[o].pivot = animator_->pivot(motion.objects[o]);
  moved_.resize(parts_.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    rest(i);
    moved_[i].version = 0;
    if (parts_[i].mover.deforms)
      moved_[i].frames.emplace(triangles_of(*scene_, parts_[i]),
                               part_of(scene_->positions, parts_[i].positions));
  }
}

void MovedScene::note_moved(std::size_t part) {
  moved_[part].version = ++versions_;
  const MovingPart& p = parts_[part];
  for (std::uint32_t c = p.chunks.first; c < p.chunks.end(); ++c)
    boxes_[c] = box_of(*scene_, p, scene_->chunks[c], moved_[part].positions);
}

void MovedScene::rest(std::size_t part) {
  const auto vertices = part_of(scene_->vertices, parts_[part].vertices);
  const auto positions = part_of(scene_->positions, parts_[part].positions);
  moved_[part].vertices.assign(vertices.begin(), vertices.end());
  moved_[part].positions.assign(positions.begin(), positions.end());
  note_moved(part);
}

void MovedScene::pose(std::optional<double> seconds) {
  if (!animator_) return;
  if (!seconds) {
    if (std::exchange(at_rest_, true)) return;
    for (Object& object : objects_) object.motion = {};
    for (std::size_t i = 0; i < parts_.size(); ++i) rest(i);
    return;
  }
  at_rest_ = false;
  animator_->pose(*seconds);
  pose_objects();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (parts_[i].mover.deforms) {
      deform(i);
    } else if (objects_[parts_[i].mover.object].moved) {
      move_rigid(i);
    }
  }
}

void MovedScene::pose_objects() {
  for (std::size_t o = 0; o < objects_.size(); ++o) {
    Object& object = objects_[o];
    // What stays rigid by its nodes may lose it to a file's numbers: then it keeps its last place.
    Pose motion = animator_->rigid_motion(scene_->motion->objects[o]).value_or(object.motion);
    if (!within_reach(object.pivot + motion.position)) motion = object.motion;
    object.moved =
        motion.position != object.motion.position || motion.orientation != object.motion.orientation;
    object.motion = motion;
  }
}

void MovedScene::move_rigid(std::size_t part) {
  const MovingPart& p = parts_[part];
  const Object& object = objects_[p.mover.object];
  const glm::dvec3 pivot = object.pivot - scene_->origin;
  const glm::dvec3 to = pivot + object.motion.position;
  const glm::dmat3 turn = glm::mat3_cast(object.motion.orientation);
  const glm::mat3 narrow(turn);
  Moved& moved = moved_[part];
  const auto rest = part_of(scene_->positions, p.positions);
  for (std::size_t i = 0; i < rest.size(); ++i)
    moved.positions[i] = glm::vec3(turn * (glm::dvec3(rest[i]) - pivot) + to);
  const auto vertices = part_of(scene_->vertices, p.vertices);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const ShadingVertex& from = vertices[i];
    ShadingVertex& out = moved.vertices[i];
    out.position = moved.positions[p.points[i]];
    out.normal = pack_normal(narrow * unpack_normal(from.normal));
    out.tangent = pack_tangent(narrow * unpack_tangent(from.tangent), is_negative_handed(from.tangent));
  }
  note_moved(part);
}

void MovedScene::deform(std::size_t part) {
  const MovingPart& p = parts_[part];
  Moved& moved = moved_[part];
  animator_->positions(p.instance, posed_);
  bool differs = false;
  for (std::size_t i = 0; i < moved.positions.size(); ++i) {
    const glm::dvec3& posed = posed_[p.sources[i]];
    const glm::vec3 at =
        within_reach(posed) ? glm::vec3(posed - scene_->origin) : scene_->positions[p.positions.first + i];
    differs = differs || at != moved.positions[i];
    moved.positions[i] = at;
  }
  if (!differs) return;
  for (std::size_t i = 0; i < moved.vertices.size(); ++i)
    moved.vertices[i].position = moved.positions[p.points[i]];
  moved.frames->turn(moved.positions, p.points, part_of(scene_->vertices, p.vertices), moved.vertices);
  note_moved(part);
}

std::optional<std::size_t> MovedScene::part_of_chunk(std::uint32_t chunk) const {
  const auto after =
      std::ranges::upper_bound(parts_, chunk, {}, [](const MovingPart& p) { return p.chunks.first; });
  if (after == parts_.begin() || chunk >= std::prev(after)->chunks.end()) return std::nullopt;
  return static_cast<std::size_t>(after - parts_.begin()) - 1;
}

const ShadingVertex& MovedScene::vertex(std::uint32_t number) const {
  const auto after =
      std::ranges::upper_bound(parts_, number, {}, [](const MovingPart& p) { return p.vertices.first; });
  if (after == parts_.begin() || number >= std::prev(after)->vertices.end()) return scene_->vertices[number];
  const auto part = static_cast<std::size_t>(after - parts_.begin()) - 1;
  return moved_[part].vertices[number - parts_[part].vertices.first];
}

namespace {

/// More samples for few vertices; at least eight, whatever it costs.
std::size_t sample_count(std::span<const MovingPart> parts) {
  constexpr std::size_t kMostVertices = std::size_t{8} << 20U;
  std::size_t vertices = 1;
  for (const MovingPart& part : parts) vertices += part.vertices.count;
  return std::clamp<std::size_t>(kMostVertices / vertices, 8, 96);
}

}  // namespace

void sweep(Scene& scene) {
  // Borrowed: it lives as long as `moved` does.
  MovedScene moved(std::shared_ptr<const Scene>(std::shared_ptr<const Scene>{}, &scene));
  double duration = 0;
  for (const RigClip& clip : scene.motion->source.rig.clips) duration = std::max(duration, clip.duration);
  const std::size_t samples = sample_count(moved.parts());
  for (std::size_t i = 0; i < samples; ++i) {
    moved.pose(duration * static_cast<double>(i) / static_cast<double>(samples));
    for (const MovingPart& part : moved.parts()) {
      for (std::uint32_t c = part.chunks.first; c < part.chunks.end(); ++c) {
        grow(scene.chunks[c].box, moved.boxes()[c].low);
        grow(scene.chunks[c].box, moved.boxes()[c].high);
        grow(scene.box, moved.boxes()[c].low);
        grow(scene.box, moved.boxes()[c].high);
      }
    }
  }
  // An object that reaches far from its pivot may be carried beyond.
  scene.box = reachable(scene.box, scene.origin);
  for (const MovingPart& part : moved.parts()) {
    for (std::uint32_t c = part.chunks.first; c < part.chunks.end(); ++c)
      scene.chunks[c].box = reachable(scene.chunks[c].box, scene.origin);
  }
}

}  // namespace atlaswire::render
