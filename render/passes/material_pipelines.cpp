#include "render/passes/material_pipelines.h"

#include "shaders/shaders.h"

#include <cstddef>
#include <map>
#include <string>

namespace atlaswire::render {
namespace {

using namespace gpu_layout;

GraphicsSettings common_settings(const SceneGpu& scene, std::uint32_t features) {
  return {.fragment = shaders::material_frag,
          .layouts = {scene.scene_layout().handle(), scene.material_layout().handle()},
          .push_constant_bytes = sizeof(DrawConstants),
          .specialization = {{0, features}},
          .colors = {vk::Format::eR8G8B8A8Unorm}};
}

GraphicsSettings atlas_settings(const SceneGpu& scene, std::uint32_t features) {
  GraphicsSettings s = common_settings(scene, features);
  s.name = "shading " + std::to_string(features);
  s.vertex = shaders::shading_vert;
  s.vertex_bindings = {{.binding = 0, .stride = 16}};
  s.vertex_attributes = {{.location = 0, .binding = 0, .format = vk::Format::eR32Uint, .offset = 0},
                         {.location = 1, .binding = 0, .format = vk::Format::eR32Uint, .offset = 4},
                         {.location = 2, .binding = 0, .format = vk::Format::eR32G32Sfloat, .offset = 8}};
  return s;
}

GraphicsSettings camera_settings(const SceneGpu& scene, std::uint32_t features) {
  const bool blended = (features & kFeatureAlphaBlend) != 0;
  if ((features & kFeatureAlphaMask) != 0) features |= kFeatureDiscard;
  GraphicsSettings s = common_settings(scene, features);
  s.name = "forward " + std::to_string(features);
  s.vertex = shaders::forward_vert;
  s.vertex_bindings = {{.binding = 0, .stride = sizeof(ShadingVertex)}};
  const auto attribute = [](std::uint32_t location, vk::Format format, std::size_t offset) {
    return vk::VertexInputAttributeDescription{
        .location = location, .binding = 0, .format = format, .offset = static_cast<std::uint32_t>(offset)};
  };
  s.vertex_attributes = {
      attribute(0, vk::Format::eR32G32B32Sfloat, offsetof(ShadingVertex, position)),
      attribute(1, vk::Format::eR32Uint, offsetof(ShadingVertex, normal)),
      attribute(2, vk::Format::eR32Uint, offsetof(ShadingVertex, tangent)),
      attribute(3, vk::Format::eR32G32Sfloat, offsetof(ShadingVertex, uv)),
  };
  s.cull = (features & kFeatureDoubleSided) != 0 ? vk::CullModeFlagBits::eNone : vk::CullModeFlagBits::eBack;
  s.depth = vk::Format::eD32Sfloat;
  s.depth_write = !blended;
  s.blend = blended;
  return s;
}

}  // namespace

MaterialPipelines::MaterialPipelines(const Device& device, const SceneGpu& scene, Target target)
    : scene_(&scene) {
  std::map<std::uint32_t, const Pipeline*> by_features;
  for (std::size_t i = 0; i < scene.scene().materials.size(); ++i) {
    const std::uint32_t features = scene.features(i);
    const Pipeline*& pipeline = by_features[features];
    if (pipeline == nullptr) {
      pipelines_.push_back(std::make_unique<Pipeline>(device, target == Target::kAtlas
                                                                  ? atlas_settings(scene, features)
                                                                  : camera_settings(scene, features)));
      pipeline = pipelines_.back().get();
    }
    of_material_.push_back(pipeline);
  }
}

void MaterialPipelines::bind(const vk::raii::CommandBuffer& commands, std::size_t material,
                             std::size_t previous) const {
  if (material == previous) return;
  const Pipeline& pipeline = *of_material_[material];
  if (previous == kNone) {
    pipeline.bind(commands, {scene_->scene_set(), scene_->material_set(material)});
    return;
  }
  if (of_material_[previous] != &pipeline) pipeline.bind(commands);
  // Layouts are compatible, so set 0 stays bound.
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, pipeline.layout(), 1,
                              scene_->material_set(material), {});
}

void MaterialPipelines::push(const vk::raii::CommandBuffer& commands, const DrawConstants& constants) const {
  if (!pipelines_.empty()) pipelines_.front()->push(commands, constants);
}

}  // namespace atlaswire::render
