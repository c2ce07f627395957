#include "render/gpu/pipeline.h"

namespace atlaswire::render {
namespace {

vk::raii::PipelineLayout make_layout(const Device& device, const std::vector<vk::DescriptorSetLayout>& sets,
                                     std::uint32_t push_bytes, vk::ShaderStageFlags stages) {
  const vk::PushConstantRange range{.stageFlags = stages, .offset = 0, .size = push_bytes};
  return {device.vk(),
          {.setLayoutCount = static_cast<std::uint32_t>(sets.size()),
           .pSetLayouts = sets.data(),
           .pushConstantRangeCount = push_bytes == 0 ? 0U : 1U,
           .pPushConstantRanges = &range}};
}

/// Specialization in the form Vulkan takes; stays where it was made.
struct SpecializationData {
  std::vector<vk::SpecializationMapEntry> entries;
  std::vector<std::uint32_t> values;
  vk::SpecializationInfo info;

  explicit SpecializationData(const Specialization& constants) {
    for (const auto& [id, value] : constants) {
      entries.push_back({.constantID = id,
                         .offset = static_cast<std::uint32_t>(values.size() * sizeof(std::uint32_t)),
                         .size = sizeof(std::uint32_t)});
      values.push_back(value);
    }
    info = {.mapEntryCount = static_cast<std::uint32_t>(entries.size()),
            .pMapEntries = entries.data(),
            .dataSize = values.size() * sizeof(std::uint32_t),
            .pData = values.data()};
  }
  SpecializationData(const SpecializationData&) = delete;
  SpecializationData& operator=(const SpecializationData&) = delete;
};

vk::raii::ShaderModule make_module(const Device& device, ShaderWords words) {
  return {device.vk(), {.codeSize = words.size_bytes(), .pCode = words.data()}};
}

vk::raii::Pipeline make_compute(const Device& device, const ComputeSettings& s, vk::PipelineLayout layout) {
  const SpecializationData constants(s.specialization);
  const vk::raii::ShaderModule shader = make_module(device, s.shader);
  return {device.vk(),
          device.pipeline_cache(),
          {.stage = {.stage = vk::ShaderStageFlagBits::eCompute,
                     .module = *shader,
                     .pName = "main",
                     .pSpecializationInfo = &constants.info},
           .layout = layout}};
}

std::vector<vk::PipelineColorBlendAttachmentState> blend_states(const GraphicsSettings& s) {
  using Factor = vk::BlendFactor;
  using Part = vk::ColorComponentFlagBits;
  const vk::ColorComponentFlags all = Part::eR | Part::eG | Part::eB | Part::eA;
  return std::vector<vk::PipelineColorBlendAttachmentState>(
      s.colors.size(), {.blendEnable = s.blend,
                        .srcColorBlendFactor = Factor::eSrcAlpha,
                        .dstColorBlendFactor = Factor::eOneMinusSrcAlpha,
                        .srcAlphaBlendFactor = Factor::eOne,
                        .dstAlphaBlendFactor = Factor::eOneMinusSrcAlpha,
                        .colorWriteMask = s.write_colors ? all : vk::ColorComponentFlags{}});
}

vk::raii::Pipeline make_graphics(const Device& device, const GraphicsSettings& s, vk::PipelineLayout layout) {
  const SpecializationData constants(s.specialization);
  const vk::raii::ShaderModule vertex = make_module(device, s.vertex);
  const bool shaded = !s.fragment.empty();
  const vk::raii::ShaderModule fragment = shaded ? make_module(device, s.fragment) : nullptr;
  const vk::PipelineShaderStageCreateInfo stages[]{{.stage = vk::ShaderStageFlagBits::eVertex,
                                                    .module = *vertex,
                                                    .pName = "main",
                                                    .pSpecializationInfo = &constants.info},
                                                   {.stage = vk::ShaderStageFlagBits::eFragment,
                                                    .module = *fragment,
                                                    .pName = "main",
                                                    .pSpecializationInfo = &constants.info}};
  const vk::PipelineVertexInputStateCreateInfo input{
      .vertexBindingDescriptionCount = static_cast<std::uint32_t>(s.vertex_bindings.size()),
      .pVertexBindingDescriptions = s.vertex_bindings.data(),
      .vertexAttributeDescriptionCount = static_cast<std::uint32_t>(s.vertex_attributes.size()),
      .pVertexAttributeDescriptions = s.vertex_attributes.data()};
  const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = s.topology};
  const vk::PipelineViewportStateCreateInfo viewport{.viewportCount = 1, .scissorCount = 1};
  const bool biased = s.depth_bias != 0.0F || s.depth_bias_slope != 0.0F;
  const vk::PipelineRasterizationStateCreateInfo raster{.cullMode = s.cull,
                                                        .frontFace = s.front,
                                                        .depthBiasEnable = biased,
                                                        .depthBiasConstantFactor = s.depth_bias,
                                                        .depthBiasSlopeFactor = s.depth_bias_slope,
                                                        .lineWidth = 1.0F};
  const vk::PipelineMultisampleStateCreateInfo samples{.rasterizationSamples = vk::SampleCountFlagBits::e1};
  const bool has_depth = s.depth != vk::Format::eUndefined;
  const vk::PipelineDepthStencilStateCreateInfo depth{.depthTestEnable = has_depth && s.depth_test,
                                                      .depthWriteEnable = has_depth && s.depth_write,
                                                      .depthCompareOp = s.depth_compare};
  const auto attachments = blend_states(s);
  const vk::PipelineColorBlendStateCreateInfo blend{
      .attachmentCount = static_cast<std::uint32_t>(attachments.size()), .pAttachments = attachments.data()};
  const vk::DynamicState dynamic_states[]{vk::DynamicState::eViewport, vk::DynamicState::eScissor};
  const vk::PipelineDynamicStateCreateInfo dynamic{.dynamicStateCount = 2, .pDynamicStates = dynamic_states};
  const vk::PipelineRenderingCreateInfo rendering{
      .colorAttachmentCount = static_cast<std::uint32_t>(s.colors.size()),
      .pColorAttachmentFormats = s.colors.data(),
      .depthAttachmentFormat = s.depth};
  return {device.vk(),
          device.pipeline_cache(),
          {.pNext = &rendering,
           .stageCount = shaded ? 2U : 1U,
           .pStages = stages,
           .pVertexInputState = &input,
           .pInputAssemblyState = &assembly,
           .pViewportState = &viewport,
           .pRasterizationState = &raster,
           .pMultisampleState = &samples,
           .pDepthStencilState = &depth,
           .pColorBlendState = &blend,
           .pDynamicState = &dynamic,
           .layout = layout}};
}

constexpr auto kGraphicsStages = vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment;

}  // namespace

Pipeline::Pipeline(const Device& device, const ComputeSettings& s)
    : point_(vk::PipelineBindPoint::eCompute),
      stages_(vk::ShaderStageFlagBits::eCompute),
      layout_(make_layout(device, s.layouts, s.push_constant_bytes, stages_)),
      pipeline_(make_compute(device, s, *layout_)) {
  device.set_name(layout_, s.name + " layout");
  device.set_name(pipeline_, s.name);
}

Pipeline::Pipeline(const Device& device, const GraphicsSettings& s)
    : point_(vk::PipelineBindPoint::eGraphics),
      stages_(kGraphicsStages),
      layout_(make_layout(device, s.layouts, s.push_constant_bytes, stages_)),
      pipeline_(make_graphics(device, s, *layout_)) {
  device.set_name(layout_, s.name + " layout");
  device.set_name(pipeline_, s.name);
}

void Pipeline::bind(const vk::raii::CommandBuffer& commands,
                    std::initializer_list<vk::DescriptorSet> sets) const {
  commands.bindPipeline(point_, *pipeline_);
  if (sets.size() > 0) commands.bindDescriptorSets(point_, *layout_, 0, sets, {});
}

void set_viewport(const vk::raii::CommandBuffer& commands, Extent2D extent) {
  commands.setViewport(0, vk::Viewport{.width = static_cast<float>(extent.width),
                                       .height = static_cast<float>(extent.height),
                                       .minDepth = 0.0F,
                                       .maxDepth = 1.0F});
  commands.setScissor(0, vk::Rect2D{.extent = {extent.width, extent.height}});
}

}  // namespace atlaswire::render
