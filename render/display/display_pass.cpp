#include "render/display/display_pass.h"

#include "render/gpu/offscreen_target.h"
#include "render/relative_camera.h"
#include "shaders/display_layout.h"
#include "shaders/shaders.h"

#include <bit>
#include <cstddef>
#include <cstring>

namespace atlaswire::render {
namespace {

using Alpha = PatchClass::Alpha;

GraphicsSettings pipeline_settings(vk::DescriptorSetLayout layout, Alpha alpha, bool double_sided) {
  return {.name = "display",
          .vertex = shaders::display_vert,
          .fragment = shaders::display_frag,
          .layouts = {layout},
          .push_constant_bytes = sizeof(gpu_layout::DisplayConstants),
          .specialization = {{0, static_cast<std::uint32_t>(alpha)}},
          .vertex_bindings = {{.binding = 0, .stride = sizeof(DisplayVertex)}},
          .vertex_attributes = {{.location = 0,
                                 .binding = 0,
                                 .format = vk::Format::eR32G32B32Sfloat,
                                 .offset = offsetof(DisplayVertex, position)},
                                {.location = 1,
                                 .binding = 0,
                                 .format = vk::Format::eR16G16Uint,
                                 .offset = offsetof(DisplayVertex, half_texel_x)}},
          .cull = double_sided ? vk::CullModeFlagBits::eNone : vk::CullModeFlagBits::eBack,
          .colors = {vk::Format::eR8G8B8A8Unorm},
          .depth = vk::Format::eD32Sfloat,
          .depth_write = alpha != Alpha::kBlend,
          .blend = alpha == Alpha::kBlend};
}

}  // namespace

DisplayPass::DisplayPass(Device& device, const AtlasTexture& atlas, const glm::vec3& background)
    : context_(device, "display", 1),
      atlas_(&atlas),
      background_(background),
      sampler_(make_sampler(device, {.name = "client atlas"})),
      layout_(device, "display",
              {{0, vk::DescriptorType::eCombinedImageSampler, vk::ShaderStageFlagBits::eFragment}}),
      sets_(device, "display", layout_, atlas.slots()) {
  for (std::uint32_t i = 0; i < atlas.slots(); ++i) sets_.write(i, 0, atlas.image(i), sampler_);
}

DisplayPass::~DisplayPass() = default;

const Pipeline& DisplayPass::pipeline(Alpha alpha, bool double_sided) {
  auto& made = pipelines_[static_cast<std::size_t>(alpha)][double_sided ? 1 : 0];
  if (made == nullptr) {
    made = std::make_unique<Pipeline>(context_.device(),
                                      pipeline_settings(layout_.handle(), alpha, double_sided));
  }
  return *made;
}

void DisplayPass::draw(const DisplayMesh& mesh, std::uint32_t slot, const Camera& camera) {
  if (camera.extent.area() == 0) return;
  prepare(mesh, camera);
  context_.run([&](const vk::raii::CommandBuffer& commands) { record(commands, mesh, slot, camera); });
}

void DisplayPass::prepare(const DisplayMesh& mesh, const Camera& camera) {
  fit_target(target_, context_.device(), "display", camera.extent);
  mesh.sort_blended(glm::vec3{camera.pose.position - mesh.origin()}, sorted_);
  if (sorted_.empty()) return;
  const std::size_t bytes = sorted_.size() * sizeof(std::uint32_t);
  if (!sorted_buffer_.has_value() || sorted_buffer_->size() < bytes) {
    sorted_buffer_.emplace(context_.device(), BufferSettings{.name = "sorted blended indices",
                                                             .size = std::bit_ceil(bytes),
                                                             .usage = vk::BufferUsageFlagBits::eIndexBuffer,
                                                             .residence = Residence::kUpload});
  }
  std::memcpy(sorted_buffer_->mapped().data(), sorted_.data(), bytes);
  sorted_buffer_->flush();
}

void DisplayPass::record(const vk::raii::CommandBuffer& commands, const DisplayMesh& mesh, std::uint32_t slot,
                         const Camera& camera) {
  target_->begin(commands, background_);
  if (!mesh.empty()) draw_classes(commands, mesh, slot, camera);
  commands.endRendering();
}

void DisplayPass::draw_classes(const vk::raii::CommandBuffer& commands, const DisplayMesh& mesh,
                               std::uint32_t slot, const Camera& camera) {
  const RelativeCamera view = relative_camera(camera, mesh.origin());
  const gpu_layout::DisplayConstants constants{
      .clip_from_relative = view.clip_from_relative,
      .camera_high = view.high,
      .camera_low = view.low,
      .atlas_from_fixed = {0.5F / static_cast<float>(atlas_->colors().width),
                           0.5F / static_cast<float>(atlas_->colors().height)}};
  commands.bindVertexBuffers(0, mesh.vertices().handle(), vk::DeviceSize{0});
  commands.bindIndexBuffer(mesh.indices().handle(), 0, vk::IndexType::eUint32);
  const auto bind = [&](Alpha alpha, bool double_sided) {
    const Pipeline& p = pipeline(alpha, double_sided);
    p.bind(commands, {sets_.handle(slot)});
    p.push(commands, constants);
  };
  for (const Alpha alpha : {Alpha::kOpaque, Alpha::kMask}) {
    for (const bool double_sided : {false, true}) {
      const MeshData::Range range = mesh.solid(alpha, double_sided);
      if (range.count == 0) continue;
      bind(alpha, double_sided);
      commands.drawIndexed(range.count, 1, range.first, 0, 0);
    }
  }
  if (!sorted_.empty()) {
    bind(Alpha::kBlend, true);
    commands.bindIndexBuffer(sorted_buffer_->handle(), 0, vk::IndexType::eUint32);
    commands.drawIndexed(static_cast<std::uint32_t>(sorted_.size()), 1, 0, 0, 0);
  }
}

const Picture& DisplayPass::read_back() {
  if (target_ != nullptr) render::read_back(context_, *target_, picture_);
  return picture_;
}

}  // namespace atlaswire::render
