#include "render/scene/gltf.h"

#include "base/log.h"
#include "render/scene/gltf_accessor.h"
#include "render/scene/gltf_looks.h"
#include "render/scene/gltf_rig.h"
#include "render/scene/light_lists.h"
#include "render/scene/scene_error.h"
#include "render/scene/tinygltf_include.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace atlaswire::render {

namespace {

constexpr int kMostDepth = 256;
constexpr const char* kKnownExtensions[] = {"KHR_lights_punctual", "KHR_materials_unlit",
                                            "KHR_materials_emissive_strength"};

glm::dmat4 local_transform(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return glm::make_mat4(node.matrix.data());
  glm::dmat4 m(1.0);
  if (node.translation.size() == 3) m = glm::translate(m, glm::make_vec3(node.translation.data()));
  if (node.rotation.size() == 4) {
    const auto& r = node.rotation;
    m *= glm::mat4_cast(glm::normalize(glm::dquat(r[3], r[0], r[1], r[2])));
  }
  if (node.scale.size() == 3) m = glm::scale(m, glm::make_vec3(node.scale.data()));
  return m;
}

class Reader {
 public:
  Reader(const tinygltf::Model& model, SceneSource& out) : model_(model), out_(out) {}

  Result<void> read() {
    for (const std::string& extension : model_.extensionsRequired) {
      if (std::find(std::begin(kKnownExtensions), std::end(kKnownExtensions), extension) ==
          std::end(kKnownExtensions)) {
        return Error{SceneError::kUnsupported, "required extension " + extension};
      }
    }
    if (auto materials = read_materials(model_, out_); materials.has_error()) return materials.error();
    meshes_.resize(model_.meshes.size());
    visited_.resize(model_.nodes.size(), false);
    for (const int root : roots()) {
      if (auto error = visit(root, glm::dmat4(1.0), {}, 0)) return *error;
    }
    if (out_.instances.empty()) return Error{SceneError::kEmpty, "no mesh in the scene's nodes"};
    if (moves()) {
      if (auto rig = read_rig(model_, out_.instances, out_.rig); rig.has_error()) return rig.error();
    }
    if (ignored_suns_ > 0)
      spdlog::warn("{} further directional lights are left out: one can cast shadows", ignored_suns_);
    return {};
  }
  [[nodiscard]] bool has_camera() const { return has_camera_; }

 private:
  [[nodiscard]] std::vector<int> roots() const {
    if (!model_.scenes.empty()) {
      const auto last = static_cast<int>(model_.scenes.size()) - 1;
      return model_.scenes[static_cast<std::size_t>(std::clamp(model_.defaultScene, 0, last))].nodes;
    }
    std::vector<bool> is_child(model_.nodes.size(), false);
    for (const tinygltf::Node& node : model_.nodes) {
      for (const int child : node.children) {
        if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
          is_child[static_cast<std::size_t>(child)] = true;
      }
    }
    std::vector<int> out;
    for (std::size_t i = 0; i < is_child.size(); ++i) {
      if (!is_child[i]) out.push_back(static_cast<int>(i));
    }
    return out;
  }

  /// `object`: name and priority that the nodes above it give.
  std::optional<Error> visit(int index, const glm::dmat4& parent, SceneObject object, int depth) {
    if (index < 0 || static_cast<std::size_t>(index) >= model_.nodes.size()) {
      return Error{SceneError::kIndexOutOfRange, "node " + std::to_string(index)};
    }
    if (depth > kMostDepth || visited_[static_cast<std::size_t>(index)]) {
      return Error{
          SceneError::kMalformed,
          "node " + std::to_string(index) + " has two parents, is its own ancestor or is nested too deeply"};
    }
    visited_[static_cast<std::size_t>(index)] = true;
    const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(index)];
    const glm::dmat4 to_scene = parent * local_transform(node);
    if (!node.name.empty()) object.name = node.name;
    object.atlas_priority = atlas_priority(node.extras).value_or(object.atlas_priority);
    if (node.mesh >= 0) {
      const RigInstance by{static_cast<std::uint32_t>(index), node.skin};
      if (auto error = place_mesh(node.mesh, to_scene, object, by)) return error;
    }
    const glm::dvec3 place(to_scene[3]);
    if (!std::isfinite(place.x + place.y + place.z)) {
      return Error{SceneError::kNotFinite, "place of node " + std::to_string(index)};
    }
    if (node.camera >= 0 && !has_camera_) place_camera(to_scene);
    if (const auto light = node.extensions.find("KHR_lights_punctual"); light != node.extensions.end()) {
      if (auto error = place_light(light->second, to_scene)) return error;
    }
    for (const int child : node.children) {
      if (auto error = visit(child, to_scene, object, depth + 1)) return error;
    }
    return std::nullopt;
  }

  void place_camera(const glm::dmat4& to_scene) {
    has_camera_ = true;
    out_.start.position = glm::dvec3(to_scene[3]);
    glm::dmat3 axes(to_scene);
    for (int c = 0; c < 3; ++c) axes[c] = glm::normalize(axes[c]);
    const glm::dquat q = glm::normalize(glm::quat_cast(axes));
    if (std::isfinite(q.w)) out_.start.orientation = q;
  }

  std::optional<Error> place_light(const tinygltf::Value& extension, const glm::dmat4& to_scene) {
    const int index = extension.Has("light") ? extension.Get("light").GetNumberAsInt() : -1;
    if (index < 0 || static_cast<std::size_t>(index) >= model_.lights.size()) {
      return Error{SceneError::kIndexOutOfRange, "light " + std::to_string(index)};
    }
    const tinygltf::Light& in = model_.lights[static_cast<std::size_t>(index)];
    glm::vec3 color(1.0F);
    if (in.color.size() == 3) color = glm::vec3(glm::make_vec3(in.color.data()));
    color *= static_cast<float>(in.intensity);
    const glm::vec3 forward(glm::normalize(glm::dmat3(to_scene) * glm::dvec3(0, 0, -1)));
    if (!(glm::dot(color, color) < 1e12F) || !std::isfinite(forward.x))
      return Error{SceneError::kNotFinite, "light " + std::to_string(index)};
    if (in.type == "directional") {
      place_sun(forward, color);
      return std::nullopt;
    }
    SourceLight light;
    light.position = glm::dvec3(to_scene[3]);
    light.light.color = color;
    light.light.range = in.range > 0 ? static_cast<float>(std::min(in.range, 1e6)) : implied_range(color);
    if (in.type == "spot") {
      light.light.direction = forward;
      light.light.cos_outer = static_cast<float>(std::cos(in.spot.outerConeAngle));
      light.light.cos_inner =
          std::max(static_cast<float>(std::cos(in.spot.innerConeAngle)), light.light.cos_outer + 1e-4F);
    }
    out_.lights.push_back(light);
    return std::nullopt;
  }

  void place_sun(const glm::vec3& forward, const glm::vec3& color) {
    if (out_.sun.color != glm::vec3(0.0F)) ++ignored_suns_;
    if (glm::dot(color, color) > glm::dot(out_.sun.color, out_.sun.color)) out_.sun = {forward, color};
  }

  /// Objects that are alike are one.
  std::uint32_t number_of(const SceneObject& object) {
    const auto [at, is_new] = objects_.try_emplace({object.name, object.atlas_priority},
                                                   static_cast<std::uint32_t>(out_.objects.size()));
    if (is_new) out_.objects.push_back(object);
    return at->second;
  }

  std::optional<Error> place_mesh(int index, const glm::dmat4& to_scene, SceneObject object,
                                  const RigInstance& by) {
    if (static_cast<std::size_t>(index) >= model_.meshes.size())
      return Error{SceneError::kIndexOutOfRange, "mesh " + std::to_string(index)};
    auto& made = meshes_[static_cast<std::size_t>(index)];
    if (made.empty()) {
      for (const tinygltf::Primitive& primitive : model_.meshes[static_cast<std::size_t>(index)].primitives) {
        auto mesh = read_primitive(primitive);
        if (mesh.has_error())
          return Error{mesh.error().code, "mesh " + std::to_string(index) + ": " + mesh.error().detail};
        if (mesh->indices.empty()) continue;
        if (moves()) {
          auto rig = read_rig_mesh(model_, primitive, mesh->vertices.size());
          if (rig.has_error())
            return Error{rig.error().code, "mesh " + std::to_string(index) + ": " + rig.error().detail};
          out_.rig.meshes.push_back(std::move(*rig));
        }
        finish(primitive, *mesh);
        made.push_back(static_cast<std::uint32_t>(out_.meshes.size()));
        out_.meshes.push_back(std::move(*mesh));
      }
    }
    if (object.name.empty()) object.name = model_.meshes[static_cast<std::size_t>(index)].name;
    const std::uint32_t number = number_of(object);
    for (const std::uint32_t mesh : made) {
      out_.instances.push_back({mesh, to_scene, number});
      if (moves()) out_.rig.instances.push_back(by);
    }
    return std::nullopt;
  }

  Result<SourceMesh> read_primitive(const tinygltf::Primitive& in) {
    SourceMesh mesh;
    if (in.mode != TINYGLTF_MODE_TRIANGLES && in.mode != -1) {
      spdlog::warn("a primitive of mode {} (not triangles) is left out", in.mode);
      return mesh;
    }
    if (in.material >= static_cast<int>(model_.materials.size()))
      return Error{SceneError::kIndexOutOfRange, "material " + std::to_string(in.material)};
    mesh.material = static_cast<std::uint16_t>(in.material >= 0 ? static_cast<std::size_t>(in.material)
                                                                : model_.materials.size());
    const auto attribute = [&in](const char* name) {
      const auto found = in.attributes.find(name);
      return found == in.attributes.end() ? -1 : found->second;
    };
    if (attribute("POSITION") < 0)
      return Error{SceneError::kMissingAttribute, "a primitive without POSITION"};
    const auto positions = read_floats(model_, attribute("POSITION"), 3);
    if (positions.has_error()) return positions.error();
    mesh.vertices.resize(positions->size() / 3);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
      mesh.vertices[i].position = glm::make_vec3(&(*positions)[i * 3]);
    if (auto error = read_triangles(in, mesh)) return *error;
    const bool normals = attribute("NORMAL") >= 0;
    if (normals) {
      if (auto error = read_attribute(attribute("NORMAL"), 3, mesh,
                                      [](SourceVertex& v, const float* f) { v.normal = glm::make_vec3(f); }))
        return *error;
    }
    if (attribute("TEXCOORD_0") >= 0) {
      if (auto error = read_attribute(attribute("TEXCOORD_0"), 2, mesh,
                                      [](SourceVertex& v, const float* f) { v.uv = glm::make_vec2(f); }))
        return *error;
    }
    if (attribute("TANGENT") >= 0 && normals && is_normal_mapped(mesh)) {
      if (auto error = read_attribute(attribute("TANGENT"), 4, mesh,
                                      [](SourceVertex& v, const float* f) { v.tangent = glm::make_vec4(f); }))
        return *error;
    }
    return mesh;
  }

  [[nodiscard]] bool is_normal_mapped(const SourceMesh& mesh) const {
    return out_.materials[mesh.material].normal_texture != kNoTexture;
  }

  /// Computes what the file leaves out. May split vertices, which then remember what moves them.
  void finish(const tinygltf::Primitive& in, SourceMesh& mesh) const {
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) mesh.vertices[i].rig = i;
    const bool normals = in.attributes.contains("NORMAL");
    if (!normals) compute_normals(mesh, true);
    if (is_normal_mapped(mesh) && !(normals && in.attributes.contains("TANGENT"))) compute_tangents(mesh);
  }

  [[nodiscard]] bool moves() const { return !model_.animations.empty(); }

  std::optional<Error> read_triangles(const tinygltf::Primitive& in, SourceMesh& mesh) {
    if (in.indices >= 0) {
      auto indices = read_indices(model_, in.indices);
      if (indices.has_error()) return indices.error();
      mesh.indices = std::move(*indices);
    } else {
      mesh.indices.resize(mesh.vertices.size());
      for (std::uint32_t i = 0; i < mesh.indices.size(); ++i) mesh.indices[i] = i;
    }
    mesh.indices.resize(mesh.indices.size() / 3 * 3);
    for (const std::uint32_t index : mesh.indices) {
      if (index >= mesh.vertices.size())
        return Error{SceneError::kIndexOutOfRange, "vertex " + std::to_string(index)};
    }
    return std::nullopt;
  }

  template <class Put>
  std::optional<Error> read_attribute(int accessor, std::uint32_t components, SourceMesh& mesh,
                                      const Put& put) {
    const auto values = read_floats(model_, accessor, components);
    if (values.has_error()) return values.error();
    if (values->size() != mesh.vertices.size() * components) {
      return Error{SceneError::kBadAccessor,
                   "accessor " + std::to_string(accessor) + " has another count than the positions"};
    }
    for (const float v : *values) {
      if (!std::isfinite(v)) return Error{SceneError::kNotFinite, "accessor " + std::to_string(accessor)};
    }
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) put(mesh.vertices[i], &(*values)[i * components]);
    return std::nullopt;
  }

  const tinygltf::Model& model_;
  SceneSource& out_;
  std::vector<std::vector<std::uint32_t>> meshes_;  ///< made of each of the file's, once placed
  std::map<std::pair<std::string, float>, std::uint32_t> objects_;
  std::vector<bool> visited_;
  bool has_camera_ = false;
  int ignored_suns_ = 0;
};

/// A view from the middle at eye height over the ground, along the longer horizontal side.
void choose_start(SceneSource& source) {
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high(-std::numeric_limits<double>::infinity());
  for (const SourceInstance& instance : source.instances) {
    for (const SourceVertex& v : source.meshes[instance.mesh].vertices) {
      const glm::dvec3 p(instance.to_scene * glm::dvec4(glm::dvec3(v.position), 1.0));
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  }
  source.start.position = 0.5 * (low + high);
  source.start.position.y = std::min(low.y + 1.7, source.start.position.y);
  if (high.x - low.x > high.z - low.z) {
    source.start.orientation = glm::angleAxis(-glm::radians(90.0), glm::dvec3(0, 1, 0));
  }
}

void light_up(SceneSource& source) {
  source.background = {0.45F, 0.62F, 0.85F};
  source.ambient_up = {0.42F, 0.46F, 0.52F};
  source.ambient_down = {0.24F, 0.21F, 0.18F};
  if (source.lights.empty() && source.sun.color == glm::vec3(0.0F)) {
    source.sun = {glm::normalize(glm::vec3(0.35F, -0.85F, 0.4F)), glm::vec3(3.6F, 3.4F, 3.0F)};
  }
}

}  // namespace

Result<SceneSource> read_gltf(const std::string& file) {
  tinygltf::Model model;
  tinygltf::TinyGLTF loader;
  std::string errors;
  std::string warnings;
  const bool binary = file.ends_with(".glb") || file.ends_with(".GLB");
  const bool read = binary ? loader.LoadBinaryFromFile(&model, &errors, &warnings, file)
                           : loader.LoadASCIIFromFile(&model, &errors, &warnings, file);
  if (!read) {
    std::replace(errors.begin(), errors.end(), '\n', ' ');
    return Error{SceneError::kMalformed, "'" + file + "': " + errors};
  }
  SceneSource source;
  source.name = std::filesystem::path(file).filename().string();  // clients are told it: no folders
  Reader reader(model, source);
  if (auto result = reader.read(); result.has_error()) {
    return Error{result.error().code, "'" + file + "': " + result.error().detail};
  }
  light_up(source);
  if (!reader.has_camera()) choose_start(source);
  return source;
}

}  // namespace atlaswire::render
