#include "render/scene/parade.h"

#include "base/assert.h"
#include "render/scene/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <utility>

namespace atlaswire::render {

namespace {

constexpr double kTau = 2 * std::numbers::pi;
constexpr double kSeconds = 8;
constexpr int kKeys = 24 * static_cast<int>(kSeconds);

enum Look : std::uint16_t { kFloor, kSkin, kCloth, kSolid };

/// A part of the figure about a joint, which swings about x once a stride.
struct Bone {
  int parent;
  glm::vec3 joint;  ///< at rest, the figure at the origin
  glm::vec3 from;   ///< of the limb that goes with it
  glm::vec3 to;
  float thick;  ///< its radius at `from`
  float thin;
  float swing;  ///< radians to both sides
  float bend;   ///< radians to one side, as knees and elbows do
  float phase;  ///< of a turn
};
constexpr std::size_t kBones = 11;
constexpr std::array<Bone, kBones> kFigure{
    {{-1, {0, 1.0F, 0}, {0, 0.88F, 0}, {0, 1.22F, 0}, 0.17F, 0.15F, 0.04F, 0, 0},
     {0, {0, 1.2F, 0}, {0, 1.14F, 0}, {0, 1.56F, 0}, 0.15F, 0.17F, 0.06F, 0, 0.5F},
     {1, {0, 1.55F, 0}, {0, 1.53F, 0}, {0, 1.86F, 0}, 0.09F, 0.11F, 0.05F, 0, 0},
     {0, {0.12F, 0.95F, 0}, {0.12F, 1, 0}, {0.12F, 0.47F, 0}, 0.1F, 0.07F, 0.5F, 0, 0},
     {3, {0.12F, 0.5F, 0}, {0.12F, 0.53F, 0}, {0.12F, 0.02F, 0}, 0.07F, 0.05F, 0, 0.9F, 0.3F},
     {0, {-0.12F, 0.95F, 0}, {-0.12F, 1, 0}, {-0.12F, 0.47F, 0}, 0.1F, 0.07F, 0.5F, 0, 0.5F},
     {5, {-0.12F, 0.5F, 0}, {-0.12F, 0.53F, 0}, {-0.12F, 0.02F, 0}, 0.07F, 0.05F, 0, 0.9F, 0.8F},
     {1, {0.22F, 1.45F, 0}, {0.21F, 1.49F, 0}, {0.26F, 1.14F, 0}, 0.06F, 0.05F, 0.45F, 0, 0.5F},
     {7, {0.26F, 1.17F, 0}, {0.26F, 1.2F, 0}, {0.27F, 0.86F, 0}, 0.05F, 0.04F, 0, -0.5F, 0.6F},
     {1, {-0.22F, 1.45F, 0}, {-0.21F, 1.49F, 0}, {-0.26F, 1.14F, 0}, 0.06F, 0.05F, 0.45F, 0, 0},
     {9, {-0.26F, 1.17F, 0}, {-0.26F, 1.2F, 0}, {-0.27F, 0.86F, 0}, 0.05F, 0.04F, 0, -0.5F, 0.1F}}};

/// A round limb, in the figure's space.
SourceMesh limb(const Bone& bone) {
  std::vector<glm::vec2> profile;
  const float length = glm::distance(bone.from, bone.to);
  constexpr int kRings = 12;
  for (int i = 0; i <= kRings; ++i) {
    const float part = static_cast<float>(i) / kRings;
    const float round = std::sqrt(std::max(0.0F, 1.0F - std::pow(std::abs(2 * part - 1), 6.0F)));
    profile.emplace_back(std::max(glm::mix(bone.thick, bone.thin, part) * round, 0.004F), length * part);
  }
  SourceMesh mesh = revolve({.profile = profile, .around = 20});
  const glm::vec3 along = (bone.to - bone.from) / length;
  const glm::vec3 axis = glm::cross(glm::vec3(0, 1, 0), along);
  const float sine = glm::length(axis);
  const glm::vec3 about = sine > 1e-4F ? axis / sine : glm::vec3(1, 0, 0);
  const glm::quat turn = glm::angleAxis(std::atan2(sine, along.y), about);
  for (SourceVertex& v : mesh.vertices) {
    v.position = bone.from + turn * v.position;
    v.normal = turn * v.normal;
  }
  return mesh;
}

/// Joints of a vertex of a limb: its own, and its neighbours' near where they meet.
void bind(std::size_t bone, const glm::vec3& at, RigMesh& rig) {
  constexpr float kReach = 0.13F;
  std::array<std::uint16_t, 4> joints{static_cast<std::uint16_t>(bone)};
  std::array<float, 4> weights{1.0F};
  std::size_t count = 1;
  const auto blend = [&](std::size_t other, const glm::vec3& joint) {
    const float near = 1.0F - glm::distance(at, joint) / kReach;
    if (near <= 0 || count == joints.size()) return;
    joints[count] = static_cast<std::uint16_t>(other);
    weights[count++] = near;
  };
  if (kFigure[bone].parent >= 0) blend(static_cast<std::size_t>(kFigure[bone].parent), kFigure[bone].joint);
  for (std::size_t other = 0; other < kBones; ++other) {
    if (kFigure[other].parent == static_cast<int>(bone)) blend(other, kFigure[other].joint);
  }
  float sum = 0;
  for (const float w : weights) sum += w;
  for (float& w : weights) w /= sum;
  rig.joints.push_back(joints);
  rig.weights.push_back(weights);
}

class Builder {
 public:
  explicit Builder(SceneSource& source) : source_(source), rig_(source.rig) {
    rig_.clips.push_back({.name = "parade", .duration = kSeconds});
  }

  void build(const ParadeOptions& options) {
    add_looks();
    place(box({-6, -0.1F, -6}, {6, 0, 6}, 1.0F, 1.0F), kFloor, add_node(-1, glm::dvec3(0.0)));
    for (std::uint32_t i = 0; i < options.figures; ++i) add_figure(i);
    for (std::uint32_t i = 0; i < options.cloths; ++i) add_cloth(i);
    for (std::uint32_t i = 0; i < options.orbiters; ++i) add_orbiter(i);
    for (std::uint32_t i = 0; i < rig_.nodes.size(); ++i) rig_.order.push_back(i);
  }

 private:
  void add_looks() {
    constexpr std::array<glm::vec3, 4> kColors{
        {{0.45F, 0.42F, 0.38F}, {0.25F, 0.35F, 0.6F}, {0.7F, 0.12F, 0.1F}, {0.75F, 0.6F, 0.2F}}};
    for (const glm::vec3& color : kColors) {
      Material material;
      material.base_color = glm::vec4(color, 1.0F);
      material.roughness = 0.7F;
      source_.materials.push_back(material);
    }
    source_.materials[kCloth].draw.double_sided = true;
  }

  std::uint32_t add_node(std::int32_t parent, const glm::dvec3& translation) {
    RigNode node;
    node.parent = parent;
    node.translation = translation;
    rig_.nodes.push_back(node);
    return static_cast<std::uint32_t>(rig_.nodes.size() - 1);
  }

  void place(SourceMesh mesh, Look look, std::uint32_t node, std::int32_t skin = -1, RigMesh rig = {}) {
    mesh.material = look;
    glm::dvec3 rest(0.0);
    for (auto n = static_cast<std::int32_t>(node); n >= 0; n = rig_.nodes[static_cast<std::size_t>(n)].parent)
      rest += rig_.nodes[static_cast<std::size_t>(n)].translation;
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) mesh.vertices[i].rig = i;
    source_.instances.push_back(
        {static_cast<std::uint32_t>(source_.meshes.size()), glm::translate(glm::dmat4(1.0), rest)});
    source_.meshes.push_back(std::move(mesh));
    rig_.instances.push_back({node, skin});
    rig_.meshes.push_back(std::move(rig));
  }

  /// `keys` + 1 keys at even times, from 0 to the clip's end.
  RigChannel& add_channel(std::uint32_t node, RigChannel::Path path, int keys,
                          const std::function<std::vector<double>(double)>& value_at) {
    RigChannel channel;
    channel.node = node;
    channel.path = path;
    channel.width = static_cast<std::uint32_t>(value_at(0).size());
    for (int i = 0; i <= keys; ++i) {
      const double t = kSeconds * i / keys;
      channel.times.push_back(static_cast<float>(t));
      for (const double v : value_at(t)) channel.values.push_back(static_cast<float>(v));
    }
    rig_.clips[0].channels.push_back(std::move(channel));
    return rig_.clips[0].channels.back();
  }

  void add_rotation(std::uint32_t node, int keys, const glm::dvec3& axis,
                    const std::function<double(double)>& angle_at) {
    add_channel(node, RigChannel::Path::kRotation, keys, [&](double t) {
      const glm::dquat q = glm::angleAxis(angle_at(t), axis);
      return std::vector<double>{q.x, q.y, q.z, q.w};
    });
  }

  /// Once around the middle in a clip, by a spline through 16 points with their true tangents.
  void add_way(std::uint32_t node, double radius, double start) {
    const auto angle = [start](double t) { return start + kTau * t / kSeconds; };
    add_channel(node, RigChannel::Path::kTranslation, 16, [&](double t) {
      const double speed = kTau / kSeconds * radius;
      const glm::dvec3 along(-speed * std::sin(angle(t)), 0, -speed * std::cos(angle(t)));
      return std::vector<double>{
          along.x, 0, along.z, radius * std::cos(angle(t)), 0, -radius * std::sin(angle(t)),
          along.x, 0, along.z};
    });
    RigChannel& way = rig_.clips[0].channels.back();
    way.interpolation = RigChannel::Interpolation::kCubicSpline;
    way.width = 3;
    // It looks along +z at rest.
    add_rotation(node, 32, {0, 1, 0}, [&](double t) { return angle(t) + kTau / 2; });
  }

  /// Each with its own pace and way, so that no two move alike.
  void add_figure(std::uint32_t number) {
    const double radius = 1.6 + 0.7 * (number % 5) + 0.03 * number;
    const double start = 2.4 * number;
    const double strides = (7.0 + number % 4) / kSeconds;  // a second
    const std::uint32_t figure = add_node(-1, radius * glm::dvec3(std::cos(start), 0.0, -std::sin(start)));
    RigSkin skin;
    SourceMesh mesh;
    RigMesh rig;
    const auto first = static_cast<std::uint32_t>(rig_.nodes.size());
    for (std::size_t b = 0; b < kBones; ++b) {
      const Bone& bone = kFigure[b];
      const auto parent = static_cast<std::size_t>(std::max(bone.parent, 0));
      const glm::vec3 from = bone.parent < 0 ? glm::vec3(0) : kFigure[parent].joint;
      const std::uint32_t above = bone.parent < 0 ? figure : first + static_cast<std::uint32_t>(parent);
      const std::uint32_t node = add_node(static_cast<std::int32_t>(above), glm::dvec3(bone.joint - from));
      skin.joints.push_back(node);
      skin.inverse_bind.push_back(glm::translate(glm::dmat4(1.0), -glm::dvec3(bone.joint)));
      add_rotation(node, kKeys, {1, 0, 0}, [&bone, strides](double t) {
        const double phase = kTau * (strides * t + bone.phase);
        return bone.swing * std::sin(phase) + bone.bend * (0.5 - 0.5 * std::cos(phase));
      });
      SourceMesh part = limb(bone);
      for (const SourceVertex& v : part.vertices) bind(b, v.position, rig);
      append(mesh, part);
    }
    add_channel(first, RigChannel::Path::kTranslation, kKeys, [strides](double t) {
      return std::vector<double>{0, kFigure[0].joint.y + 0.025 * std::cos(2 * kTau * strides * t), 0};
    });
    add_way(figure, radius, start);
    rig_.skins.push_back(std::move(skin));
    place(std::move(mesh), kSkin, figure, static_cast<std::int32_t>(rig_.skins.size()) - 1, std::move(rig));
  }

  /// Two waves run along it, each a sine and a cosine whose weights turn.
  void add_cloth(std::uint32_t number) {
    constexpr std::array<std::pair<float, double>, 2> kWaves{
        {{5.5F, 8.0}, {12.0F, 18.0}}};  // radians, turns a clip
    const std::uint32_t node = add_node(-1, glm::dvec3(-4.5 + 0.4 * number, 1.4, -3.0 + 0.9 * number));
    SourceMesh mesh = sheet(34, 34, [](float u, float v) {
      SourceVertex out;
      out.position = {1.6F * u, 1.0F * v, 0};
      out.uv = {u, v};
      return out;
    });
    RigMesh rig;
    for (const auto& [around, turns] : kWaves) {
      for (const double shift : {0.0, kTau / 4}) {
        std::vector<glm::vec3>& morph = rig.morphs.emplace_back();
        for (const SourceVertex& v : mesh.vertices) {
          const float phase = around * v.uv.x + 1.5F * v.uv.y + static_cast<float>(shift);
          const float reach = 0.9F * v.uv.x / around;
          morph.emplace_back(0.1F * reach * std::cos(2 * phase), 0, reach * std::sin(phase));
        }
      }
    }
    rig_.nodes[node].weights.assign(4, 0.0);
    add_channel(node, RigChannel::Path::kWeights, kKeys, [&](double t) {
      std::vector<double> weights;
      for (const auto& [around, turns] : kWaves) {
        const double phase = kTau * turns * t / kSeconds;
        weights.insert(weights.end(), {std::cos(phase), -std::sin(phase)});
      }
      return weights;
    });
    place(std::move(mesh), kCloth, node, -1, std::move(rig));
  }

  void add_orbiter(std::uint32_t number) {
    const double radius = 3.0 + 0.25 * (number % 8);
    const std::uint32_t pivot = add_node(-1, glm::dvec3(0, 0.6 + 0.35 * (number % 6), 0));
    const double start = 2.4 * number;
    const std::uint32_t solid =
        add_node(static_cast<std::int32_t>(pivot), radius * glm::dvec3(std::cos(start), 0, std::sin(start)));
    if (number % 4 != 3) {
      const int laps = 1 + static_cast<int>(number % 3);
      const int spins = 2 + static_cast<int>(number % 5);
      add_rotation(pivot, 8 * laps, glm::normalize(glm::dvec3(0.1, 1, 0)),
                   [laps](double t) { return kTau * laps * t / kSeconds; });
      add_rotation(solid, 8 * spins, glm::normalize(glm::dvec3(1, 0.3 * number, 0.5)),
                   [spins](double t) { return kTau * spins * t / kSeconds; });
    }
    const float side = 0.15F + 0.02F * static_cast<float>(number % 5);
    place(box(glm::vec3(-side), glm::vec3(side), side, 2.0F), kSolid, solid);
  }

  SceneSource& source_;
  Rig& rig_;
};

}  // namespace

SceneSource make_parade(const ParadeOptions& options) {
  AW_ASSERT(std::max({options.figures, options.cloths, options.orbiters}) <= 64 &&
            options.figures + options.cloths + options.orbiters > 0);
  SceneSource source;
  source.name = "parade";
  Builder(source).build(options);
  source.sun = {glm::normalize(glm::vec3(0.35F, -0.85F, 0.4F)), glm::vec3(3.6F, 3.4F, 3.0F)};
  source.ambient_up = {0.42F, 0.46F, 0.52F};
  source.ambient_down = {0.24F, 0.21F, 0.18F};
  source.background = {0.45F, 0.62F, 0.85F};
  source.start.position = {0, 1.7, 5.5};
  return source;
}

}  // namespace atlaswire::render
