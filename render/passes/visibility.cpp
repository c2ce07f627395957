#include "render/passes/visibility.h"

#include "base/assert.h"
#include "render/gpu/barriers.h"
#include "render/passes/visibility_frustum.h"
#include "render/relative_camera.h"
#include "render/scene/surface_priorities.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace atlaswire::render {
namespace {

using visibility::DrawCommand;

visibility::ViewConstants view_constants(const Camera& view, const glm::dvec3& origin) {
  const RelativeCamera camera = relative_camera(view, origin);
  return {
      .clip_from_relative = camera.clip_from_relative, .camera_high = camera.high, .camera_low = camera.low};
}

/// The display's pixels along one radian at its centre: d(x)/d(angle) of x = f tan(angle) at 0, where
/// f = (height / 2) / tan(vertical field of view / 2). [SAS] eq. 1 calls it r / f.
double pixels_per_radian(const Camera& camera) {
  return camera.extent.height / 2.0 / std::tan(camera.vertical_fov / 2);
}

Extent2D scaled(Extent2D extent, double scale) {
  const auto side = [&](std::uint32_t length) {
    return static_cast<std::uint32_t>(std::max(1L, std::lround(length * scale)));
  };
  return {side(extent.width), side(extent.height)};
}

vk::RenderingAttachmentInfo target(const Image& image, bool clear, vk::ClearValue value) {
  return {.imageView = image.view(),
          .imageLayout = image.layout(),
          .loadOp = clear ? vk::AttachmentLoadOp::eClear : vk::AttachmentLoadOp::eLoad,
          .storeOp = vk::AttachmentStoreOp::eStore,
          .clearValue = value};
}

DrawCommand unconditional(const visibility::ChunkCandidate& chunk) {
  return {.index_count = chunk.index_count,
          .instance_count = 1,
          .first_index = chunk.first_index,
          .vertex_offset = 0,
          .first_instance = 0};
}

}  // namespace

VisibilityPass::VisibilityPass(Device& device, const SceneGpu& scene, const VisibilitySettings& settings)
    : device_(&device),
      scene_(&scene),
      settings_(settings),
      geometry_(device, scene.scene()),
      layout_(device, "visibility", visibility_bindings()),
      sets_(device, "visibility", layout_),
      pipelines_(device, scene, layout_),
      sampler_(make_sampler(device, {.name = "nearest", .filter = vk::Filter::eNearest})),
      commands_(device, {.name = "id draws",
                         .size = settings.max_views * scene.scene().chunks.size() * sizeof(DrawCommand),
                         .usage = vk::BufferUsageFlagBits::eIndirectBuffer,
                         .residence = Residence::kUpload}) {
  if (settings.occlusion) {
    occlusion_.emplace(device, static_cast<std::uint32_t>(settings.max_views * scene.scene().chunks.size()));
  }
  if (scene.scene().motion) moved_.emplace(device, scene.scene());
  AW_ASSERT(settings.max_views >= 1 && settings.fov_scale >= 1 && settings.id_scale > 0);
  sets_.write(0, 1, geometry_.marks);
  sets_.write(0, 3, geometry_.positions);
  sets_.write(0, 4, geometry_.corners);
  sets_.write(0, 5, geometry_.levels);
  sets_.write(0, 6, geometry_.list);
  sets_.write(0, 7, geometry_.priorities);
  sets_.write(0, 8, geometry_.held);
  set_emphasis({});
}

void VisibilityPass::set_emphasis(const Emphasis& emphasis) {
  foveation_ = emphasis.foveation.value_or(0);
  const std::vector<float> octaves = surface_priorities(scene_->scene(), emphasis);
  std::ranges::copy(octaves, geometry_.priorities.mapped<float>().begin());
  geometry_.priorities.flush();
}

void VisibilityPass::make_targets(Extent2D extent) {
  if (ids_ != nullptr && ids_->extent() == extent) return;
  using Usage = vk::ImageUsageFlagBits;
  ids_ = std::make_unique<Image>(
      *device_, ImageSettings{.name = "ids",
                              .extent = extent,
                              .format = kIdFormat,
                              .usage = Usage::eColorAttachment | Usage::eSampled | Usage::eTransferSrc});
  depth_ = std::make_unique<Image>(*device_,
                                   ImageSettings{.name = "id depth",
                                                 .extent = extent,
                                                 .format = kIdDepthFormat,
                                                 .usage = Usage::eDepthStencilAttachment | Usage::eSampled});
  sets_.write(0, 2, *ids_, sampler_);
  if (occlusion_) occlusion_->set_depth(*depth_);
}

void VisibilityPass::find_known_chunks() {
  const Scene& scene = scene_->scene();
  const auto words = levels();
  known_.assign(scene.chunks.size(), true);
  if (!occlusion_) return;
  for (std::size_t i = 0; i < scene.chunks.size(); ++i) {
    const Chunk& chunk = scene.chunks[i];
    // Blended chunks are drawn last and hide nothing: always tested.
    known_[i] = id_class(scene.materials[chunk.material]) != IdClass::kBlended &&
                std::ranges::any_of(patches_of(scene, chunk), [&](std::uint32_t p) { return words[p] != 0; });
  }
}

void VisibilityPass::record(const vk::raii::CommandBuffer& commands, const Camera& camera,
                            std::span<const Pose> poses) {
  AW_ASSERT(!poses.empty() && poses.size() <= settings_.max_views);
  Camera view = enlarged(camera, settings_.fov_scale);
  view.extent = scaled(view.extent, settings_.id_scale);
  make_targets(view.extent);
  stats_ = {.views = static_cast<std::uint32_t>(poses.size())};
  find_known_chunks();
  if (moved_) moved_->record(commands, scene_->moved(), geometry_);
  clear_results(commands);
  for (std::uint32_t i = 0; i < poses.size(); ++i) {
    view.pose = poses[i];
    compute_to_draw(commands);
    record_view(commands, view, i);
    record_marks(commands);
  }
  if (settings_.hold_frames != 0) record_hold(commands);
  record_levels(commands, camera);
}

void VisibilityPass::record_view(const vk::raii::CommandBuffer& commands, const Camera& view,
                                 std::uint32_t index) {
  const Scene& scene = scene_->scene();
  const std::span<const Box> boxes = scene_->moved().boxes();
  const ViewVolume volume(view, scene.origin);
  std::vector<std::uint32_t> known;
  std::vector<std::uint32_t> others;
  for (std::uint32_t i = 0; i < scene.chunks.size(); ++i) {
    if (volume.may_see(boxes[i])) (known_[i] ? known : others).push_back(i);
  }
  stats_.chunks_in_view += static_cast<std::uint32_t>(known.size() + others.size());
  stats_.chunks_tested += static_cast<std::uint32_t>(others.size());

  const visibility::ViewConstants constants = view_constants(view, scene.origin);
  const auto first = static_cast<std::uint32_t>(index * scene.chunks.size());
  const DrawList sure = list_draws(scene, boxes, known, true);
  std::ranges::transform(sure.candidates, commands_.mapped<DrawCommand>().begin() + first, unconditional);
  commands_.flush();
  discard_image(commands, *ids_, ImageUse::kColorTarget);
  discard_image(commands, *depth_, ImageUse::kDepthTarget);
  draw(commands, constants, sure, commands_, first, true);

  if (others.empty()) return;
  const DrawList tested = list_draws(scene, boxes, others, false);
  occlusion_->record(commands, *depth_, constants, tested, first);
  use_image(commands, *ids_, ImageUse::kColorTarget);
  use_image(commands, *depth_, ImageUse::kDepthTarget);
  draw(commands, constants, tested, occlusion_->commands(), first, false);
}

void VisibilityPass::draw(const vk::raii::CommandBuffer& commands, const visibility::ViewConstants& view,
                          const DrawList& list, const Buffer& indirect, std::uint32_t first_command,
                          bool clear) {
  const auto color =
      target(*ids_, clear, vk::ClearColorValue(std::array<std::uint32_t, 4>{visibility::kNoPatch}));
  const auto depth = target(*depth_, clear, vk::ClearDepthStencilValue{.depth = 0.0F});
  const Extent2D extent = ids_->extent();
  commands.beginRendering({.renderArea = {.extent = {extent.width, extent.height}},
                           .layerCount = 1,
                           .colorAttachmentCount = 1,
                           .pColorAttachments = &color,
                           .pDepthAttachment = &depth});
  set_viewport(commands, extent);
  commands.bindIndexBuffer(geometry_.indices.handle(), 0, vk::IndexType::eUint32);
  for (const DrawRange& range : list.ranges) {
    const bool opaque = range.id_class == IdClass::kOpaque;
    const Pipeline& pipeline = pipelines_.draw(range.id_class, range.double_sided);
    if (opaque) {
      pipeline.bind(commands, {sets_.handle()});
      commands.bindVertexBuffers(0, geometry_.solid.handle(), vk::DeviceSize{0});
    } else {
      pipeline.bind(commands, {sets_.handle(), scene_->material_set(range.material)});
      commands.bindVertexBuffers(0, geometry_.cut.handle(), vk::DeviceSize{0});
    }
    pipeline.push(commands, view);
    commands.drawIndexedIndirect(indirect.handle(),
                                 (first_command + range.first_command) * sizeof(DrawCommand),
                                 range.command_count, sizeof(DrawCommand));
  }
  commands.endRendering();
}

void VisibilityPass::record_marks(const vk::raii::CommandBuffer& commands) {
  use_image(commands, *ids_, ImageUse::kSampledInCompute);
  fragment_to_compute(commands);
  pipelines_.mark().bind(commands, {sets_.handle()});
  commands.dispatch(group_count(ids_->extent().width, 8 * visibility::kMarkRun),
                    group_count(ids_->extent().height, 8), 1);
}

void VisibilityPass::clear_results(const vk::raii::CommandBuffer& commands) {
  shaders_to_transfer(commands);
  const std::array<std::uint32_t, visibility::kListHeader> header{0, 1, 1, 0};
  commands.updateBuffer<std::uint32_t>(geometry_.list.handle(), 0, header);
  commands.fillBuffer(geometry_.levels.handle(), 0, VK_WHOLE_SIZE, 0);
  transfer_to_shaders(commands);
}

void VisibilityPass::record_hold(const vk::raii::CommandBuffer& commands) {
  const auto patches = static_cast<std::uint32_t>(scene_->scene().patches.size());
  compute_to_compute(commands);
  pipelines_.hold().bind(commands, {sets_.handle()});
  pipelines_.hold().push(commands, visibility::HoldConstants{patches, settings_.hold_frames});
  commands.dispatch(group_count(patches, visibility::kListGroup), 1, 1);
}

void VisibilityPass::record_levels(const vk::raii::CommandBuffer& commands, const Camera& camera) {
  visibility::LevelConstants constants{.camera_high = {},
                                       .camera_low = {},
                                       .pixels_per_radian = static_cast<float>(pixels_per_radian(camera)),
                                       .foveation = static_cast<float>(foveation_),
                                       .foveal_angle = std::numbers::pi_v<float> / 18,
                                       .padding = {},
                                       .gaze = {}};
  constants.gaze = glm::vec4(glm::vec3(camera.pose.orientation * glm::dvec3{0, 0, -1}), 0.0F);
  split(camera.pose.position - scene_->scene().origin, constants.camera_high, constants.camera_low);
  compute_to_compute(commands);
  compute_to_draw(commands);
  pipelines_.level().bind(commands, {sets_.handle()});
  pipelines_.level().push(commands, constants);
  commands.dispatchIndirect(geometry_.list.handle(), 0);
  writes_to_host(commands);
}

std::span<const std::uint32_t> VisibilityPass::levels() const {
  geometry_.levels.invalidate();
  return geometry_.levels.mapped<const std::uint32_t>().first(scene_->scene().patches.size());
}

}  // namespace atlaswire::render
