#include "render/passes/forward.h"

#include "render/passes/frustum.h"
#include "render/passes/tonemap.h"
#include "render/relative_camera.h"

#include <algorithm>

namespace atlaswire::render {
namespace {

gpu_layout::DrawConstants draw_constants(const RelativeCamera& camera) {
  return {.clip_from_relative = camera.clip_from_relative,
          .camera_high = camera.high,
          .camera_low = camera.low,
          .clip_from_texel = {0.0F, 0.0F},
          .light_list = 0};
}

std::vector<std::uint32_t> count_triangles(const Scene& scene) {
  std::vector<std::uint32_t> first(scene.patches.size());
  std::uint32_t triangle = 0;
  for (const std::uint32_t patch : scene.drawn) {
    first[patch] = triangle;
    triangle += scene.patches[patch].triangles;
  }
  return first;
}

/// A blended patch and how far it is.
struct BlendedPatch {
  float distance2 = 0.0F;
  std::uint32_t patch = 0;
  std::uint32_t chunk = 0;
};

float distance2_of(const MovedScene& moved, const Patch& patch, const glm::vec3& eye) {
  glm::vec3 sum{0.0F};
  const std::uint32_t corners = corner_count(patch.triangles);
  for (std::uint32_t i = 0; i < corners; ++i) sum += moved.vertex(patch.vertices[i]).position;
  const glm::vec3 away = sum / static_cast<float>(corners) - eye;
  return glm::dot(away, away);
}

}  // namespace

ForwardPass::ForwardPass(Device& device, const SceneGpu& scene)
    : context_(device, "forward", 1),
      scene_(&scene),
      pipelines_(device, scene, MaterialPipelines::Target::kCamera),
      first_triangle_(count_triangles(scene.scene())),
      query_(device.vk(), {.queryType = vk::QueryType::eOcclusion, .queryCount = 1}) {
  device.set_name(query_, "forward fragments");
  if (device.features().occlusionQueryPrecise == VK_TRUE) precision_ = vk::QueryControlFlagBits::ePrecise;
}

Picture ForwardPass::render(const Camera& camera) {
  Picture picture(camera.extent);
  if (picture.empty()) return picture;
  fit_target(target_, context_.device(), "forward", camera.extent);
  context_.run([&](const vk::raii::CommandBuffer& commands) {
    commands.resetQueryPool(*query_, 0, 1);
    commands.beginQuery(*query_, 0, precision_);
    record(commands, camera, *target_);
    commands.endQuery(*query_, 0);
    target_->record_readback(commands);
  });
  fragments_ =
      query_.getResult<std::uint64_t>(0, 1, sizeof(std::uint64_t), vk::QueryResultFlagBits::e64).second;
  target_->copy_to(picture);
  return picture;
}

void ForwardPass::record(const vk::raii::CommandBuffer& commands, const Camera& camera,
                         OffscreenTarget& target, OffscreenTarget::Depth depth_after) const {
  const Scene& scene = scene_->scene();
  target.begin(commands, display_color(scene.background, scene.exposure), depth_after);
  draw_scene(commands, camera);
  commands.endRendering();
}

void ForwardPass::draw_scene(const vk::raii::CommandBuffer& commands, const Camera& camera) const {
  const Scene& scene = scene_->scene();
  const RelativeCamera view = relative_camera(camera, scene.origin);
  gpu_layout::DrawConstants constants = draw_constants(view);
  commands.bindVertexBuffers(0, scene_->vertices().handle(), vk::DeviceSize{0});
  commands.bindIndexBuffer(scene_->indices().handle(), 0, vk::IndexType::eUint32);

  std::size_t bound = MaterialPipelines::kNone;
  const auto draw = [&](std::size_t chunk, std::uint32_t first_triangle, std::uint32_t triangles) {
    const std::size_t material = scene.chunks[chunk].material;
    pipelines_.bind(commands, material, bound);
    bound = material;
    constants.light_list = scene_->lights().of_chunk[chunk];
    pipelines_.push(commands, constants);
    commands.drawIndexed(triangles * 3, 1, first_triangle * 3, 0, 0);
  };

  // Solid chunks from near to far, so that most hidden pixels are never shaded.
  std::vector<std::pair<float, std::uint32_t>> solid;
  std::vector<BlendedPatch> blended;
  const glm::vec3 eye{view.high};
  for (std::uint32_t i = 0; i < scene.chunks.size(); ++i) {
    const Chunk& chunk = scene.chunks[i];
    const Box& box = scene_->moved().boxes()[i];
    if (!may_see(view, box)) continue;
    if (scene.materials[chunk.material].draw.alpha != PatchClass::Alpha::kBlend) {
      const glm::vec3 away = eye - glm::clamp(eye, box.low, box.high);
      solid.emplace_back(glm::dot(away, away), i);
      continue;
    }
    for (const std::uint32_t p : patches_of(scene, chunk)) {
      blended.push_back({distance2_of(scene_->moved(), scene.patches[p], eye), p, i});
    }
  }
  std::ranges::sort(solid);
  for (const auto& [distance2, chunk] : solid) {
    draw(chunk, scene.chunks[chunk].first_triangle, scene.chunks[chunk].triangle_count);
  }
  std::ranges::stable_sort(blended, std::ranges::greater{}, &BlendedPatch::distance2);
  for (const BlendedPatch& b : blended) {
    draw(b.chunk, first_triangle_[b.patch], scene.patches[b.patch].triangles);
  }
}

}  // namespace atlaswire::render
