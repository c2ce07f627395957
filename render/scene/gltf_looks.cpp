#include "render/scene/gltf_looks.h"

#include "base/log.h"
#include "render/scene/scene_error.h"
#include "render/scene/tinygltf_include.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

namespace atlaswire::render {

namespace {

constexpr std::uint32_t kMostTexelsASide = 8192;

float unit(double v) { return std::isfinite(v) ? static_cast<float>(std::clamp(v, 0.0, 1.0)) : 1.0F; }

class Looks {
 public:
  Looks(const tinygltf::Model& model, SceneSource& source) : model_(model), source_(source) {}

  Result<void> read() {
    if (model_.materials.size() >= 65'535) return Error{SceneError::kTooLarge, "more than 65534 materials"};
    for (const tinygltf::Material& m : model_.materials) {
      if (auto error = read_material(m)) return *error;
    }
    Material plain;
    plain.name = "none";
    source_.materials.push_back(plain);
    return {};
  }

 private:
  std::optional<Error> read_material(const tinygltf::Material& in) {
    Material out;
    out.name = in.name;
    const auto& pbr = in.pbrMetallicRoughness;
    for (int c = 0; c < 4 && pbr.baseColorFactor.size() == 4; ++c) {
      out.base_color[c] = unit(pbr.baseColorFactor[static_cast<std::size_t>(c)]);
    }
    out.metallic = unit(pbr.metallicFactor);
    out.roughness = unit(pbr.roughnessFactor);
    for (int c = 0; c < 3 && in.emissiveFactor.size() == 3; ++c) {
      out.emissive[c] = unit(in.emissiveFactor[static_cast<std::size_t>(c)]);
    }
    out.normal_scale = static_cast<float>(in.normalTexture.scale);
    out.draw.double_sided = in.doubleSided;
    if (in.alphaMode == "MASK") out.draw.alpha = PatchClass::Alpha::kMask;
    if (in.alphaMode == "BLEND") out.draw.alpha = PatchClass::Alpha::kBlend;
    out.alpha_cutoff = unit(in.alphaCutoff);
    out.atlas_priority = atlas_priority(in.extras).value_or(0.0F);
    const struct {
      int index;
      int uv_set;
      bool srgb;
      std::int32_t* out;
    } wanted[] = {
        {pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord, true, &out.base_color_texture},
        {pbr.metallicRoughnessTexture.index, pbr.metallicRoughnessTexture.texCoord, false,
         &out.metallic_roughness_texture},
        {in.normalTexture.index, in.normalTexture.texCoord, false, &out.normal_texture},
        {in.emissiveTexture.index, in.emissiveTexture.texCoord, true, &out.emissive_texture},
    };
    for (const auto& w : wanted) {
      if (w.index < 0) continue;
      if (w.uv_set != 0) {
        spdlog::warn("material '{}': texture coordinate set {} is not supported, texture left out", in.name,
                     w.uv_set);
        continue;
      }
      const auto texture = use_texture(w.index, w.srgb);
      if (texture.has_error()) return texture.error();
      *w.out = *texture;
    }
    read_extensions(in, out);
    source_.materials.push_back(std::move(out));
    return std::nullopt;
  }

  static void read_extensions(const tinygltf::Material& in, Material& out) {
    if (const auto it = in.extensions.find("KHR_materials_emissive_strength"); it != in.extensions.end()) {
      const auto& strength = it->second.Get("emissiveStrength");
      if (strength.IsNumber())
        out.emissive *= static_cast<float>(std::clamp(strength.GetNumberAsDouble(), 0.0, 1e4));
    }
    if (in.extensions.count("KHR_materials_unlit") > 0) {
      out.emissive = glm::vec3(out.base_color);
      out.emissive_texture = out.base_color_texture;
      out.base_color = {0.0F, 0.0F, 0.0F, out.base_color.w};
      out.roughness = 1.0F;
      out.metallic = 0.0F;
    }
  }

  Result<std::int32_t> use_texture(int index, bool srgb) {
    if (const auto known = used_.find({index, srgb}); known != used_.end()) return known->second;
    if (static_cast<std::size_t>(index) >= model_.textures.size()) {
      return Error{SceneError::kIndexOutOfRange, "texture " + std::to_string(index)};
    }
    const tinygltf::Texture& in = model_.textures[static_cast<std::size_t>(index)];
    if (in.source < 0 || static_cast<std::size_t>(in.source) >= model_.images.size()) {
      return Error{SceneError::kIndexOutOfRange, "image of texture " + std::to_string(index)};
    }
    const auto pixels = to_rgba8(model_.images[static_cast<std::size_t>(in.source)], in.source);
    if (pixels.has_error()) return pixels.error();
    Texture out = *pixels;
    out.srgb = srgb;
    if (in.sampler >= 0 && static_cast<std::size_t>(in.sampler) < model_.samplers.size()) {
      const tinygltf::Sampler& sampler = model_.samplers[static_cast<std::size_t>(in.sampler)];
      out.repeat_u = sampler.wrapS != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
      out.repeat_v = sampler.wrapT != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
      out.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    source_.textures.push_back(std::move(out));
    const auto number = static_cast<std::int32_t>(source_.textures.size() - 1);
    used_[{index, srgb}] = number;
    return number;
  }

  static Result<Texture> to_rgba8(const tinygltf::Image& in, int index) {
    const auto bad = [index](const char* why) {
      return Error{SceneError::kBadImage, "image " + std::to_string(index) + " " + why};
    };
    if (in.width <= 0 || in.height <= 0 || in.component < 1 || in.component > 4) return bad("is empty");
    Texture out;
    out.name = in.name.empty() ? in.uri : in.name;
    out.extent = {static_cast<std::uint32_t>(in.width), static_cast<std::uint32_t>(in.height)};
    if (out.extent.width > kMostTexelsASide || out.extent.height > kMostTexelsASide)
      return bad("is larger than 8192 texels a side");
    const std::size_t octets = in.bits == 16 ? 2 : 1;
    const auto components = static_cast<std::size_t>(in.component);
    if (in.image.size() != out.extent.area() * components * octets) return bad("has an unknown layout");
    out.rgba.resize(out.extent.area() * 4);
    for (std::size_t i = 0; i < out.extent.area(); ++i) {
      // The most significant octet of a 16-bit sample comes second.
      const auto sample = [&](std::size_t c) {
        return in.image[(i * components + c) * octets + (octets - 1)];
      };
      const bool grey = components < 3;
      for (std::size_t c = 0; c < 3; ++c) out.rgba[i * 4 + c] = sample(grey ? 0 : c);
      out.rgba[i * 4 + 3] = components == 4 ? sample(3) : components == 2 ? sample(1) : 255;
    }
    return out;
  }

  const tinygltf::Model& model_;
  SceneSource& source_;
  std::map<std::pair<int, bool>, std::int32_t> used_;
};

}  // namespace

std::optional<float> atlas_priority(const tinygltf::Value& extras) {
  if (!extras.IsObject() || !extras.Has("atlas_priority")) return std::nullopt;
  const tinygltf::Value& value = extras.Get("atlas_priority");
  if (!value.IsNumber() || !std::isfinite(value.GetNumberAsDouble())) return std::nullopt;
  return static_cast<float>(std::clamp(value.GetNumberAsDouble(), -8.0, 8.0));
}

Result<void> read_materials(const tinygltf::Model& model, SceneSource& source) {
  return Looks(model, source).read();
}

}  // namespace atlaswire::render
