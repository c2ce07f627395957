#include "render/scene/gltf_rig.h"

#include "base/log.h"
#include "render/scene/gltf_accessor.h"
#include "render/scene/scene_error.h"
#include "render/scene/tinygltf_include.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <optional>
#include <string>

namespace atlaswire::render {

namespace {

constexpr std::size_t kMostNumbers = std::size_t{1}
                                     << 26U;  ///< in a clip's values, so that a short file stays small
constexpr std::size_t kMostJoints = 65'536;

/// Numbers of an accessor, all finite; `components` each.
Result<std::vector<float>> read_finite(const tinygltf::Model& model, int accessor, std::uint32_t components) {
  if (accessor >= 0 && static_cast<std::size_t>(accessor) < model.accessors.size() &&
      model.accessors[static_cast<std::size_t>(accessor)].count > kMostNumbers / components) {
    return Error{SceneError::kTooLarge, "accessor " + std::to_string(accessor)};
  }
  auto values = read_floats(model, accessor, components);
  if (values.has_error()) return values.error();
  if (!std::ranges::all_of(*values, [](float v) { return std::isfinite(v); }))
    return Error{SceneError::kNotFinite, "accessor " + std::to_string(accessor)};
  return values;
}

bool all_finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
}

class Reader {
 public:
  Reader(const tinygltf::Model& model, Rig& rig) : model_(model), rig_(rig) {}

  std::optional<Error> read(const std::vector<SourceInstance>& instances) {
    if (auto error = read_nodes()) return error;
    if (auto error = sort_nodes()) return error;
    if (auto error = read_skins()) return error;
    for (std::size_t i = 0; i < instances.size(); ++i) {
      if (auto error = check(rig_.instances[i], rig_.meshes[instances[i].mesh])) return error;
    }
    std::size_t numbers = 0;
    for (const tinygltf::Animation& animation : model_.animations) {
      if (auto error = read_clip(animation, numbers)) return error;
    }
    return std::nullopt;
  }

 private:
  std::optional<Error> read_nodes() {
    for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
      const tinygltf::Node& in = model_.nodes[i];
      RigNode node;
      if (in.matrix.size() == 16) node.matrix = glm::make_mat4(in.matrix.data());
      if (in.translation.size() == 3) node.translation = glm::make_vec3(in.translation.data());
      if (in.rotation.size() == 4)
        node.rotation =
            glm::normalize(glm::dquat(in.rotation[3], in.rotation[0], in.rotation[1], in.rotation[2]));
      if (in.scale.size() == 3) node.scale = glm::make_vec3(in.scale.data());
      node.weights = in.weights;
      if (node.weights.empty() && in.mesh >= 0 && static_cast<std::size_t>(in.mesh) < model_.meshes.size())
        node.weights = model_.meshes[static_cast<std::size_t>(in.mesh)].weights;
      if (!all_finite(in.matrix) || !all_finite(in.translation) || !all_finite(in.scale) ||
          !std::isfinite(node.rotation.w) || !all_finite(node.weights)) {
        return Error{SceneError::kNotFinite, "node " + std::to_string(i)};
      }
      rig_.nodes.push_back(std::move(node));
    }
    for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
      for (const int child : model_.nodes[i].children) {
        if (!is_node(child)) return Error{SceneError::kIndexOutOfRange, "node " + std::to_string(child)};
        RigNode& node = rig_.nodes[static_cast<std::size_t>(child)];
        if (node.parent >= 0)
          return Error{SceneError::kMalformed, "node " + std::to_string(child) + " has two parents"};
        node.parent = static_cast<std::int32_t>(i);
      }
    }
    return std::nullopt;
  }

  std::optional<Error> sort_nodes() {
    for (std::uint32_t i = 0; i < rig_.nodes.size(); ++i) {
      if (rig_.nodes[i].parent < 0) rig_.order.push_back(i);
    }
    for (std::size_t at = 0; at < rig_.order.size(); ++at) {
      for (const int child : model_.nodes[rig_.order[at]].children)
        rig_.order.push_back(static_cast<std::uint32_t>(child));
    }
    if (rig_.order.size() == rig_.nodes.size()) return std::nullopt;
    return Error{SceneError::kMalformed, "a node is its own ancestor"};
  }

  std::optional<Error> read_skins() {
    for (std::size_t i = 0; i < model_.skins.size(); ++i) {
      const tinygltf::Skin& in = model_.skins[i];
      const std::string name = "skin " + std::to_string(i);
      if (in.joints.empty() || in.joints.size() > kMostJoints)
        return Error{SceneError::kMalformed, name + " has no joints or too many"};
      RigSkin skin;
      for (const int joint : in.joints) {
        if (!is_node(joint))
          return Error{SceneError::kIndexOutOfRange, name + ": joint " + std::to_string(joint)};
        skin.joints.push_back(static_cast<std::uint32_t>(joint));
      }
      skin.inverse_bind.resize(skin.joints.size(), glm::dmat4(1.0));
      if (in.inverseBindMatrices >= 0) {
        const auto numbers = read_finite(model_, in.inverseBindMatrices, 16);
        if (numbers.has_error()) return numbers.error();
        if (numbers->size() < skin.joints.size() * 16)
          return Error{SceneError::kBadAccessor, name + " has fewer inverse bind matrices than joints"};
        for (std::size_t j = 0; j < skin.joints.size(); ++j)
          skin.inverse_bind[j] = glm::dmat4(glm::make_mat4(&(*numbers)[j * 16]));
      }
      rig_.skins.push_back(std::move(skin));
    }
    return std::nullopt;
  }

  /// A mesh may be used with several skins, so its joints are checked where it is placed.
  [[nodiscard]] std::optional<Error> check(const RigInstance& instance, const RigMesh& mesh) const {
    if (instance.skin < 0) return std::nullopt;
    const std::string name = "skin " + std::to_string(instance.skin);
    if (static_cast<std::size_t>(instance.skin) >= rig_.skins.size())
      return Error{SceneError::kIndexOutOfRange, name};
    const std::size_t count = rig_.skins[static_cast<std::size_t>(instance.skin)].joints.size();
    for (const auto& joints : mesh.joints) {
      if (std::ranges::any_of(joints, [count](std::uint16_t j) { return j >= count; }))
        return Error{SceneError::kIndexOutOfRange, name + ": a vertex names a joint that it has not"};
    }
    return std::nullopt;
  }

  std::optional<Error> read_clip(const tinygltf::Animation& in, std::size_t& numbers) {
    RigClip clip;
    clip.name = in.name;
    for (const tinygltf::AnimationChannel& channel : in.channels) {
      if (channel.target_node < 0) continue;  // glTF: ignored
      if (!is_node(channel.target_node))
        return Error{SceneError::kIndexOutOfRange, "node " + std::to_string(channel.target_node)};
      if (channel.sampler < 0 || static_cast<std::size_t>(channel.sampler) >= in.samplers.size())
        return Error{SceneError::kIndexOutOfRange, "sampler " + std::to_string(channel.sampler)};
      RigChannel out;
      out.node = static_cast<std::uint32_t>(channel.target_node);
      if (!choose_path(channel.target_path, out)) {
        spdlog::warn("a channel for '{}' of node {} is left out", channel.target_path, out.node);
        continue;
      }
      if (auto error = read_keys(in.samplers[static_cast<std::size_t>(channel.sampler)], out)) return error;
      numbers += out.times.size() + out.values.size();
      if (numbers > kMostNumbers) return Error{SceneError::kTooLarge, "animation '" + in.name + "'"};
      clip.duration = std::max(clip.duration, double{out.times.back()});
      clip.channels.push_back(std::move(out));
    }
    if (!clip.channels.empty()) rig_.clips.push_back(std::move(clip));
    return std::nullopt;
  }

  bool choose_path(const std::string& path, RigChannel& out) const {
    const RigNode& node = rig_.nodes[out.node];
    if (path == "weights") {
      out.path = RigChannel::Path::kWeights;
      out.width = static_cast<std::uint32_t>(targets_of(out.node));
      return out.width > 0;
    }
    if (node.matrix) return false;
    if (path == "rotation") {
      out.path = RigChannel::Path::kRotation;
      out.width = 4;
      return true;
    }
    out.path = path == "scale" ? RigChannel::Path::kScale : RigChannel::Path::kTranslation;
    return path == "scale" || path == "translation";
  }

  [[nodiscard]] std::size_t targets_of(std::uint32_t node) const {
    const int mesh = model_.nodes[node].mesh;
    if (mesh < 0 || static_cast<std::size_t>(mesh) >= model_.meshes.size()) return 0;
    const auto& primitives = model_.meshes[static_cast<std::size_t>(mesh)].primitives;
    return primitives.empty() ? 0 : primitives[0].targets.size();
  }

  std::optional<Error> read_keys(const tinygltf::AnimationSampler& in, RigChannel& out) {
    const bool cubic = in.interpolation == "CUBICSPLINE";
    if (!cubic && in.interpolation != "LINEAR" && in.interpolation != "STEP")
      return Error{SceneError::kMalformed, "interpolation '" + in.interpolation + "'"};
    out.interpolation = cubic                        ? RigChannel::Interpolation::kCubicSpline
                        : in.interpolation == "STEP" ? RigChannel::Interpolation::kStep
                                                     : RigChannel::Interpolation::kLinear;
    auto times = read_finite(model_, in.input, 1);
    if (times.has_error()) return times.error();
    const auto descends = std::ranges::adjacent_find(*times, [](float a, float b) { return a >= b; });
    if (times->empty() || times->front() < 0 || descends != times->end())
      return Error{SceneError::kMalformed, "times of keys do not ascend from 0 on"};
    out.times = std::move(*times);
    const bool scalars = out.path == RigChannel::Path::kWeights;
    auto values = read_finite(model_, in.output, scalars ? 1 : out.width);
    if (values.has_error()) return values.error();
    if (values->size() != out.times.size() * out.width * (cubic ? 3 : 1))
      return Error{SceneError::kBadAccessor,
                   "accessor " + std::to_string(in.output) + " has another count than the keys"};
    out.values = std::move(*values);
    return std::nullopt;
  }

  [[nodiscard]] bool is_node(int index) const {
    return index >= 0 && static_cast<std::size_t>(index) < model_.nodes.size();
  }

  const tinygltf::Model& model_;
  Rig& rig_;
};

Error other_count(int accessor) {
  return {SceneError::kBadAccessor,
          "accessor " + std::to_string(accessor) + " has another count than the positions"};
}

}  // namespace

Result<RigMesh> read_rig_mesh(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                              std::size_t vertices) {
  RigMesh out;
  const auto joints = primitive.attributes.find("JOINTS_0");
  const auto weights = primitive.attributes.find("WEIGHTS_0");
  if (joints != primitive.attributes.end() && weights != primitive.attributes.end()) {
    const auto numbers = read_finite(model, joints->second, 4);
    if (numbers.has_error()) return numbers.error();
    const auto shares = read_finite(model, weights->second, 4);
    if (shares.has_error()) return shares.error();
    if (numbers->size() != vertices * 4) return other_count(joints->second);
    if (shares->size() != vertices * 4) return other_count(weights->second);
    out.joints.resize(vertices);
    out.weights.resize(vertices);
    for (std::size_t i = 0; i < vertices * 4; ++i) {
      const float joint = (*numbers)[i];
      const float weight = std::max(0.0F, (*shares)[i]);
      // What weighs nothing may name anything.
      if (!(weight > 0)) continue;
      if (joint < 0 || joint > 65'535 || joint != std::floor(joint))
        return Error{SceneError::kIndexOutOfRange,
                     "accessor " + std::to_string(joints->second) + ": a joint"};
      out.joints[i / 4][i % 4] = static_cast<std::uint16_t>(joint);
      out.weights[i / 4][i % 4] = weight;
    }
  }
  if (vertices * primitive.targets.size() > kMostNumbers / 3)
    return Error{SceneError::kTooLarge, "morph targets"};
  for (const auto& target : primitive.targets) {
    std::vector<glm::vec3>& morph = out.morphs.emplace_back(vertices, glm::vec3(0.0F));
    const auto found = target.find("POSITION");
    if (found == target.end()) continue;
    const auto numbers = read_finite(model, found->second, 3);
    if (numbers.has_error()) return numbers.error();
    if (numbers->size() != vertices * 3) return other_count(found->second);
    for (std::size_t i = 0; i < vertices; ++i) morph[i] = glm::make_vec3(&(*numbers)[i * 3]);
  }
  return out;
}

Result<void> read_rig(const tinygltf::Model& model, const std::vector<SourceInstance>& instances, Rig& rig) {
  if (auto error = Reader(model, rig).read(instances)) return *error;
  return {};
}

}  // namespace atlaswire::render
