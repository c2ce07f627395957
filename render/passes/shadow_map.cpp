#include "render/passes/shadow_map.h"

#include "render/passes/scene_gpu.h"
#include "shaders/shaders.h"

#include <vector>

namespace atlaswire::render {
namespace {

Pipeline make_pipeline(const Device& device, const SceneGpu& scene, bool masked) {
  GraphicsSettings settings{.name = masked ? "masked shadow casters" : "shadow casters",
                            .vertex = shaders::shadow_vert,
                            .layouts = {scene.scene_layout().handle(), scene.material_layout().handle()},
                            .vertex_bindings = {{.binding = 0, .stride = sizeof(ShadingVertex)}},
                            .vertex_attributes = {{.location = 0,
                                                   .binding = 0,
                                                   .format = vk::Format::eR32G32B32Sfloat,
                                                   .offset = offsetof(ShadingVertex, position)},
                                                  {.location = 1,
                                                   .binding = 0,
                                                   .format = vk::Format::eR32G32Sfloat,
                                                   .offset = offsetof(ShadingVertex, uv)}},
                            .depth = vk::Format::eD32Sfloat};
  if (masked) settings.fragment = shaders::shadow_frag;
  return {device, settings};
}

void begin_depth(const vk::raii::CommandBuffer& commands, Image& map, bool keep = false) {
  if (keep) {
    use_image(commands, map, ImageUse::kDepthTarget);
  } else {
    discard_image(commands, map, ImageUse::kDepthTarget);
  }
  const vk::RenderingAttachmentInfo depth{
      .imageView = map.view(),
      .imageLayout = map.layout(),
      .loadOp = keep ? vk::AttachmentLoadOp::eLoad : vk::AttachmentLoadOp::eClear,
      .storeOp = vk::AttachmentStoreOp::eStore,
      .clearValue = vk::ClearDepthStencilValue{.depth = 0.0F}};
  commands.beginRendering({.renderArea = {.extent = {map.extent().width, map.extent().height}},
                           .layerCount = 1,
                           .pDepthAttachment = &depth});
}

}  // namespace

void clear_shadow_map(const vk::raii::CommandBuffer& commands, Image& map) {
  begin_depth(commands, map);
  commands.endRendering();
  use_image(commands, map, ImageUse::kSampledInFragment);
}

ShadowPass::ShadowPass(const Device& device, const SceneGpu& scene)
    : solid_(make_pipeline(device, scene, false)), masked_(make_pipeline(device, scene, true)) {}

void ShadowPass::record(const vk::raii::CommandBuffer& commands, const SceneGpu& scene, Image& map,
                        Casters casters) const {
  const std::vector<Chunk>& chunks = scene.scene().chunks;
  begin_depth(commands, map, casters == Casters::kMoving);
  set_viewport(commands, map.extent());
  commands.bindVertexBuffers(0, scene.vertices().handle(), vk::DeviceSize{0});
  commands.bindIndexBuffer(scene.indices().handle(), 0, vk::IndexType::eUint32);
  for (std::uint32_t i = 0; i < chunks.size(); ++i) {
    const auto alpha = scene.scene().materials[chunks[i].material].draw.alpha;
    if (alpha == PatchClass::Alpha::kBlend) continue;
    const bool moves = casters != Casters::kAll && scene.moved().part_of_chunk(i).has_value();
    if (casters != Casters::kAll && moves != (casters == Casters::kMoving)) continue;
    const Pipeline& pipeline = alpha == PatchClass::Alpha::kMask ? masked_ : solid_;
    pipeline.bind(commands, {scene.scene_set(), scene.material_set(chunks[i].material)});
    commands.drawIndexed(chunks[i].triangle_count * 3, 1, chunks[i].first_triangle * 3, 0, 0);
  }
  commands.endRendering();
}

MovingShadows::MovingShadows(SubmitContext& context, const SceneGpu& scene, Extent2D extent)
    : pass_(context.device(), scene),
      resting_(context.device(), {.name = "resting shadows",
                                  .extent = extent,
                                  .format = vk::Format::eD32Sfloat,
                                  .usage = vk::ImageUsageFlagBits::eDepthStencilAttachment |
                                           vk::ImageUsageFlagBits::eTransferSrc}) {
  context.run([&](const vk::raii::CommandBuffer& commands) {
    pass_.record(commands, scene, resting_, Casters::kResting);
    use_image(commands, resting_, ImageUse::kTransferSource);
  });
}

void MovingShadows::record(const vk::raii::CommandBuffer& commands, const SceneGpu& scene, Image& map) {
  discard_image(commands, map, ImageUse::kTransferTarget);
  const vk::ImageSubresourceLayers depth{.aspectMask = map.aspect(), .layerCount = 1};
  commands.copyImage(resting_.handle(), resting_.layout(), map.handle(), map.layout(),
                     vk::ImageCopy{.srcSubresource = depth,
                                   .dstSubresource = depth,
                                   .extent = {map.extent().width, map.extent().height, 1}});
  pass_.record(commands, scene, map, Casters::kMoving);
  use_image(commands, map, ImageUse::kSampledInFragment);
}

}  // namespace atlaswire::render
