#include "render/passes/visibility_pipelines.h"

#include "base/assert.h"
#include "render/passes/visibility_mesh.h"
#include "shaders/shaders.h"
#include "shaders/visibility_layout.h"

namespace atlaswire::render {
namespace {

using Type = vk::DescriptorType;
using Stage = vk::ShaderStageFlagBits;

constexpr const char* kNames[6]{"ids opaque",  "ids opaque double-sided",
                                "ids masked",  "ids masked double-sided",
                                "ids blended", "ids blended double-sided"};

std::size_t slot(IdClass id_class, bool double_sided) {
  return 2 * static_cast<std::size_t>(id_class) + (double_sided ? 1 : 0);
}

GraphicsSettings draw_settings(const SceneGpu& scene, const DescriptorLayout& layout, IdClass id_class,
                               bool double_sided) {
  GraphicsSettings s{
      .name = kNames[slot(id_class, double_sided)],
      .vertex = shaders::visibility_vert,
      .fragment = shaders::visibility_frag,
      .layouts = {layout.handle()},
      .push_constant_bytes = sizeof(visibility::ViewConstants),
      .vertex_bindings = {{.binding = 0, .stride = sizeof(IdVertex)}},
      .vertex_attributes = {{.location = 0, .format = vk::Format::eR32G32B32Sfloat},
                            {.location = 1,
                             .format = vk::Format::eR32Uint,
                             .offset = offsetof(IdVertex, patch)}},
      .cull = double_sided ? vk::CullModeFlags{} : vk::CullModeFlagBits::eBack,
      .colors = {kIdFormat},
      .depth = kIdDepthFormat,
  };
  if (id_class == IdClass::kOpaque) return s;
  s.vertex = shaders::visibility_masked_vert;
  s.fragment = shaders::visibility_masked_frag;
  s.layouts.push_back(scene.material_layout().handle());
  s.vertex_bindings = {{.binding = 0, .stride = sizeof(CutVertex)}};
  static_assert(offsetof(CutVertex, patch) == offsetof(IdVertex, patch));
  s.vertex_attributes.push_back(
      {.location = 2, .format = vk::Format::eR32G32Sfloat, .offset = offsetof(CutVertex, uv)});
  if (id_class == IdClass::kBlended) {
    s.fragment = shaders::visibility_blended_frag;
    s.depth_write = false;
    s.write_colors = false;
  }
  return s;
}

}  // namespace

std::vector<Binding> visibility_bindings() {
  return {{.binding = 1, .type = Type::eStorageBuffer, .stages = Stage::eFragment | Stage::eCompute},
          {.binding = 2, .type = Type::eCombinedImageSampler, .stages = Stage::eCompute},
          {.binding = 3, .type = Type::eStorageBuffer, .stages = Stage::eCompute},
          {.binding = 4, .type = Type::eStorageBuffer, .stages = Stage::eCompute},
          {.binding = 5, .type = Type::eStorageBuffer, .stages = Stage::eCompute},
          {.binding = 6, .type = Type::eStorageBuffer, .stages = Stage::eFragment | Stage::eCompute},
          {.binding = 7, .type = Type::eStorageBuffer, .stages = Stage::eCompute},
          {.binding = 8, .type = Type::eStorageBuffer, .stages = Stage::eCompute}};
}

VisibilityPipelines::VisibilityPipelines(const Device& device, const SceneGpu& scene,
                                         const DescriptorLayout& layout)
    : mark_(device, ComputeSettings{.name = "mark visible",
                                    .shader = shaders::visibility_mark_comp,
                                    .layouts = {layout.handle()}}),
      hold_(device, ComputeSettings{.name = "hold visible",
                                    .shader = shaders::visibility_hold_comp,
                                    .layouts = {layout.handle()},
                                    .push_constant_bytes = sizeof(visibility::HoldConstants)}),
      level_(device, ComputeSettings{.name = "levels",
                                     .shader = shaders::visibility_level_comp,
                                     .layouts = {layout.handle()},
                                     .push_constant_bytes = sizeof(visibility::LevelConstants)}) {
  for (const Chunk& chunk : scene.scene().chunks) {
    const Material& material = scene.scene().materials[chunk.material];
    auto& pipeline = draws_[slot(id_class(material), material.draw.double_sided)];
    if (pipeline) continue;
    pipeline.emplace(device, draw_settings(scene, layout, id_class(material), material.draw.double_sided));
  }
}

const Pipeline& VisibilityPipelines::draw(IdClass id_class, bool double_sided) const {
  const auto& pipeline = draws_[slot(id_class, double_sided)];
  AW_ASSERT(pipeline.has_value());
  return *pipeline;
}

}  // namespace atlaswire::render
