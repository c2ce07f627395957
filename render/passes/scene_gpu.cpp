#include "render/passes/scene_gpu.h"

#include "base/assert.h"
#include "render/gpu/barriers.h"
#include "render/passes/shadow_map.h"
#include "shaders/scene_layout.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace atlaswire::render {
namespace {

using Usage = vk::BufferUsageFlagBits;
using Stage = vk::ShaderStageFlagBits;
using Type = vk::DescriptorType;

/// Of an object that outlives the use of the result.
template <class T>
std::span<const std::byte> bytes_of(const T& object) {
  return std::as_bytes(std::span<const T, 1>(&object, 1));
}

/// Small and host-visible memory is fine for constants; geometry goes through a copy to the device.
Buffer upload_small(const Device& device, const std::string& name, std::span<const std::byte> bytes,
                    std::size_t size, vk::BufferUsageFlags usage) {
  Buffer buffer(device, {.name = name,
                         .size = std::max<std::size_t>(size, bytes.size()),
                         .usage = usage,
                         .residence = Residence::kUpload});
  if (!bytes.empty()) std::memcpy(buffer.mapped().data(), bytes.data(), bytes.size());
  buffer.flush();
  return buffer;
}

Buffer upload(SubmitContext& context, const std::string& name, std::vector<std::span<const std::byte>> parts,
              vk::BufferUsageFlags usage) {
  std::size_t size = 0;
  for (const auto& part : parts) size += part.size();
  Buffer target(context.device(), {.name = name, .size = size, .usage = usage | Usage::eTransferDst});
  if (size == 0) return target;
  const Buffer staging(context.device(), {.name = name + " staging",
                                          .size = size,
                                          .usage = Usage::eTransferSrc,
                                          .residence = Residence::kUpload});
  std::byte* to = staging.mapped().data();
  for (const auto& part : parts) {
    if (!part.empty()) std::memcpy(to, part.data(), part.size());
    to += part.size();
  }
  staging.flush();
  context.run([&](const vk::raii::CommandBuffer& commands) {
    commands.copyBuffer(staging.handle(), target.handle(), vk::BufferCopy{.size = size});
    transfer_to_shaders(commands);
  });
  return target;
}

std::vector<std::uint32_t> find_solos(const Scene& scene) {
  std::vector<std::uint32_t> solos;
  for (std::uint32_t i = 0; i < scene.patches.size(); ++i) {
    if (scene.patches[i].triangles == 1) solos.push_back(i);
  }
  return solos;
}

std::vector<ShadingVertex> make_fourth_corners(const Scene& scene, std::span<const std::uint32_t> solos) {
  std::vector<ShadingVertex> made;
  made.reserve(solos.size());
  for (const std::uint32_t patch : solos) {
    const auto& corners = scene.patches[patch].vertices;
    made.push_back(
        fourth_corner(scene.vertices[corners[0]], scene.vertices[corners[1]], scene.vertices[corners[2]]));
  }
  return made;
}

Buffer upload_vertices(SubmitContext& context, const Scene& scene, std::span<const std::uint32_t> solos) {
  const std::vector<ShadingVertex> corners = make_fourth_corners(scene, solos);
  return upload(context, "vertices",
                {std::as_bytes(std::span(scene.vertices)), std::as_bytes(std::span(corners))},
                Usage::eVertexBuffer | Usage::eStorageBuffer);
}

vk::ImageUsageFlags shadow_usage(const Scene& scene) {
  using ImageUsage = vk::ImageUsageFlagBits;
  const vk::ImageUsageFlags usage = ImageUsage::eDepthStencilAttachment | ImageUsage::eSampled;
  return scene.motion ? usage | ImageUsage::eTransferDst : usage;
}

/// What the sun's view must hold: what rests, and all places where something moves.
ShadowFit fit_shadow_to(const Scene& scene, float size) {
  if (!scene.motion) return fit_shadow(scene.vertices, scene.sun.direction, size);
  std::vector<ShadingVertex> held = scene.vertices;
  for (const MovingPart& part : scene.motion->parts) {
    for (std::uint32_t c = part.chunks.first; c < part.chunks.end(); ++c) {
      const Box& box = scene.chunks[c].box;
      for (unsigned corner = 0; corner < 8; ++corner) {
        held.push_back({.position = {(corner & 1U) != 0 ? box.low.x : box.high.x,
                                     (corner & 2U) != 0 ? box.low.y : box.high.y,
                                     (corner & 4U) != 0 ? box.low.z : box.high.z}});
      }
    }
  }
  return fit_shadow(held, scene.sun.direction, size);
}

bool has_sun(const Scene& scene) {
  return std::max({scene.sun.color.x, scene.sun.color.y, scene.sun.color.z}) > 0.0F;
}

/// Finer for wide scenes: 2048 a side up to 60 m.
std::uint32_t shadow_side(const Scene& scene) {
  if (!has_sun(scene)) return 1;
  const glm::vec3 size = scene.box.high - scene.box.low;
  return std::max({size.x, size.y, size.z}) > 60.0F ? 4096 : 2048;
}

gpu_layout::SceneConstants scene_constants(const Scene& scene, const ShadowFit& fit) {
  gpu_layout::SceneConstants c{};
  c.ambient_up = {scene.ambient_up, 0.0F};
  c.ambient_down = {scene.ambient_down, 0.0F};
  c.sun_color = {scene.sun.color, scene.exposure};
  c.to_sun = {-glm::normalize(scene.sun.direction), static_cast<float>(shadow_side(scene))};
  for (std::size_t i = 0; i < 3; ++i) c.shadow_row[i] = fit.rows[i];
  c.shadow_offsets = {1.5F * fit.texel, 0.5F * fit.texel / fit.depth, 0.0F, 0.0F};
  return c;
}

gpu_layout::MaterialConstants material_constants(const Material& m) {
  return {.base_color = m.base_color,
          .emissive = {m.emissive, 0.0F},
          .factors = {m.metallic, m.roughness, m.normal_scale, m.alpha_cutoff}};
}

std::uint32_t features_of(const Material& m, const Scene& scene, const LightTable& lights) {
  using namespace gpu_layout;
  const auto bit = [](bool on, std::uint32_t feature) { return on ? feature : 0U; };
  const bool emits = std::max({m.emissive.x, m.emissive.y, m.emissive.z}) > 0.0F;
  return bit(m.base_color_texture != kNoTexture, kFeatureBaseTexture) |
         bit(m.metallic_roughness_texture != kNoTexture, kFeatureMetallicRoughnessTexture) |
         bit(m.normal_texture != kNoTexture, kFeatureNormalMap) | bit(emits, kFeatureEmissive) |
         bit(emits && m.emissive_texture != kNoTexture, kFeatureEmissiveTexture) |
         bit(m.draw.alpha == PatchClass::Alpha::kMask, kFeatureAlphaMask) |
         bit(m.draw.alpha == PatchClass::Alpha::kBlend, kFeatureAlphaBlend) |
         bit(m.draw.double_sided, kFeatureDoubleSided) | bit(has_sun(scene), kFeatureSun) |
         bit(lights.used(), kFeatureLights) | bit(lights.used() && lights.spots, kFeatureSpots);
}

std::vector<Binding> scene_bindings() {
  return {{0, Type::eUniformBuffer, Stage::eVertex | Stage::eFragment},
          {1, Type::eUniformBuffer, Stage::eFragment},
          {2, Type::eStorageBuffer, Stage::eFragment},
          {3, Type::eCombinedImageSampler, Stage::eFragment},
          {4, Type::eStorageBuffer, Stage::eVertex}};
}

std::vector<Binding> material_bindings() {
  std::vector<Binding> bindings{{0, Type::eUniformBuffer, Stage::eFragment}};
  for (std::uint32_t i = 1; i <= 4; ++i) {
    bindings.push_back({i, Type::eCombinedImageSampler, Stage::eFragment});
  }
  return bindings;
}

}  // namespace

SceneGpu::SceneGpu(Device& device, std::shared_ptr<const Scene> scene)
    : scene_(std::move(scene)),
      moved_(scene_),
      context_(device, "scene upload", 1),
      solo_patches_(find_solos(*scene_)),
      lights_(make_light_table(*scene_)),
      shadow_fit_(fit_shadow_to(*scene_, static_cast<float>(shadow_side(*scene_)))),
      vertices_(upload_vertices(context_, *scene_, solo_patches_)),
      indices_(upload(context_, "indices", {std::as_bytes(std::span(scene_->indices))},
                      Usage::eIndexBuffer | Usage::eStorageBuffer)),
      triangle_patch_(upload(context_, "patch of triangle",
                             {std::as_bytes(std::span(scene_->triangle_patch))}, Usage::eStorageBuffer)),
      constants_(upload_small(device, "scene constants", bytes_of(scene_constants(*scene_, shadow_fit_)), 0,
                              Usage::eUniformBuffer)),
      light_buffer_(upload_small(device, "lights", std::as_bytes(std::span(lights_.lights)),
                                 gpu_layout::kMaxLights * sizeof(gpu_layout::LightConstants),
                                 Usage::eUniformBuffer)),
      light_list_(upload_small(device, "light lists", std::as_bytes(std::span(lights_.lists)), 0,
                               Usage::eStorageBuffer)),
      textures_(context_, scene_->textures),
      shadow_map_(device, {.name = "shadow map",
                           .extent = {shadow_side(*scene_), shadow_side(*scene_)},
                           .format = vk::Format::eD32Sfloat,
                           .usage = shadow_usage(*scene_)}),
      shadow_sampler_(make_sampler(device, {.name = "shadow sampler", .depth_compare = true})),
      scene_layout_(device, "scene set", scene_bindings()),
      material_layout_(device, "material set", material_bindings()),
      scene_sets_(device, "scene set", scene_layout_),
      material_sets_(device, "material set", material_layout_,
                     static_cast<std::uint32_t>(scene_->materials.size())) {
  if (lights_.dropped > 0) {
    spdlog::warn("scene {}: {} lights are too many, the {} weakest are left out", scene_->name,
                 scene_->lights.size(), lights_.dropped);
  }
  for (const Material& m : scene_->materials) features_.push_back(features_of(m, *scene_, lights_));
  write_scene_set();
  write_material_sets(device);
  if (scene_->motion) moved_vertices_.emplace(device, *scene_, solo_patches_);
  draw_shadows();
}

void SceneGpu::draw_shadows() {
  using Commands = vk::raii::CommandBuffer;
  if (!has_sun(*scene_)) {
    return context_.run([&](const Commands& commands) { clear_shadow_map(commands, shadow_map_); });
  }
  if (scene_->motion) {
    shadows_.emplace(context_, *this, shadow_map_.extent());
    return context_.run([&](const Commands& commands) { shadows_->record(commands, *this, shadow_map_); });
  }
  const ShadowPass pass(context_.device(), *this);
  context_.run([&](const Commands& commands) {
    pass.record(commands, *this, shadow_map_, Casters::kAll);
    use_image(commands, shadow_map_, ImageUse::kSampledInFragment);
  });
}

void SceneGpu::record_moves(const vk::raii::CommandBuffer& commands) {
  if (!moved_vertices_ || !moved_vertices_->record(commands, *scene_, moved_, vertices_)) return;
  if (shadows_) shadows_->record(commands, *this, shadow_map_);
}

void SceneGpu::move_to(std::optional<double> seconds) {
  if (!moved_vertices_) return;
  pose(seconds);
  context_.run([&](const vk::raii::CommandBuffer& commands) { record_moves(commands); });
}

std::uint32_t SceneGpu::fourth_corner(PatchId patch) const {
  const auto found = std::ranges::lower_bound(solo_patches_, value(patch));
  AW_ASSERT(found != solo_patches_.end() && *found == value(patch));
  return static_cast<std::uint32_t>(scene_->vertices.size() +
                                    static_cast<std::size_t>(found - solo_patches_.begin()));
}

void SceneGpu::write_scene_set() {
  scene_sets_.write(0, 0, constants_);
  scene_sets_.write(0, 1, light_buffer_);
  scene_sets_.write(0, 2, light_list_);
  scene_sets_.write(0, 3, shadow_map_, shadow_sampler_);
  scene_sets_.write(0, 4, vertices_);
}

void SceneGpu::write_material_sets(const Device& device) {
  for (std::size_t i = 0; i < scene_->materials.size(); ++i) {
    const Material& m = scene_->materials[i];
    const auto set = static_cast<std::uint32_t>(i);
    materials_.push_back(upload_small(device, "material " + m.name, bytes_of(material_constants(m)), 0,
                                      Usage::eUniformBuffer));
    material_sets_.write(set, 0, materials_.back());
    const std::int32_t textures[] = {m.base_color_texture, m.metallic_roughness_texture, m.normal_texture,
                                     m.emissive_texture};
    for (std::uint32_t slot = 0; slot < 4; ++slot) {
      material_sets_.write(set, slot + 1, textures_.image(textures[slot]), textures_.sampler(textures[slot]));
    }
  }
}

}  // namespace atlaswire::render
