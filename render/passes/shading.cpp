#include "render/passes/shading.h"

#include "base/assert.h"
#include "base/patch_layout.h"
#include "render/relative_camera.h"

#include <algorithm>
#include <bit>

namespace atlaswire::render {
namespace {

/// A patch's corner in the atlas: what shaders/shading.vert reads.
struct Corner {
  std::uint32_t vertex;
  std::uint32_t light_list;
  float x;
  float y;
};
static_assert(sizeof(Corner) == 16);

/// Corners of a block's patch as rasterised. The client interpolates between the centres of a block's outer
/// texels (corner_texel), so attributes are exact there; but a triangle that ends on texel centres loses
/// some of them to the rasteriser's top-left rule, so it ends 1/64 texel farther out. A side of one texel
/// spans that texel instead: it gets the middle of the patch, filtered over all of it.
constexpr float kOutward = 1.0F / 64.0F;

float low_edge(std::uint32_t side) { return side == 1 ? 0.0F : 0.5F - kOutward; }
float high_edge(std::uint32_t side) { return side == 1 ? 1.0F : static_cast<float>(side) - 0.5F + kOutward; }

struct BlockFrame {
  explicit BlockFrame(const Block& b)
      : x(static_cast<float>(b.x)),
        y(static_cast<float>(b.y)),
        low_x(low_edge(b.width())),
        low_y(low_edge(b.height())),
        span_x(high_edge(b.width()) - low_x),
        span_y(high_edge(b.height()) - low_y),
        transposed(b.transposed) {}

  [[nodiscard]] Corner corner(std::uint32_t vertex, std::uint32_t light_list, float u, float v) const {
    if (transposed) std::swap(u, v);
    return {vertex, light_list, x + low_x + u * span_x, y + low_y + v * span_y};
  }

  float x, y, low_x, low_y, span_x, span_y;
  bool transposed;
};

/// A one-triangle patch is drawn as the parallelogram that it is half of.
constexpr std::uint32_t drawn_triangles(std::uint32_t triangles) { return std::max(triangles, 2U); }

constexpr std::size_t kMaxIndices = std::size_t{kMaxPatchTriangles} * 3;

}  // namespace

ShadingPass::ShadingPass(Device& device, const SceneGpu& scene, Extent2D atlas,
                         std::uint32_t frames_in_flight)
    : device_(&device),
      scene_(&scene),
      pipelines_(device, scene, MaterialPipelines::Target::kAtlas),
      atlas_(device, {.name = "shading atlas",
                      .extent = atlas,
                      .format = vk::Format::eR8G8B8A8Unorm,
                      .usage = vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eSampled |
                               vk::ImageUsageFlagBits::eTransferSrc}),
      frames_(std::max(frames_in_flight, 1U)) {}

std::uint64_t ShadingPass::record(const vk::raii::CommandBuffer& commands,
                                  std::span<const PlacedPatch> patches, const glm::dvec3& eye, bool clear) {
  Frame& frame = frames_[next_frame_];
  next_frame_ = (next_frame_ + 1) % frames_.size();
  reserve(frame, patches.size());
  const std::uint64_t texels = write_geometry(frame, patches);

  const bool fresh = clear || atlas_.layout() == vk::ImageLayout::eUndefined;
  use_image(commands, atlas_, ImageUse::kColorTarget);
  const vk::RenderingAttachmentInfo color{
      .imageView = atlas_.view(),
      .imageLayout = atlas_.layout(),
      .loadOp = fresh ? vk::AttachmentLoadOp::eClear : vk::AttachmentLoadOp::eLoad,
      .storeOp = vk::AttachmentStoreOp::eStore,
      .clearValue = vk::ClearColorValue(std::array{0.5F, 0.5F, 0.5F, 0.0F})};
  commands.beginRendering({.renderArea = {.extent = {atlas_.extent().width, atlas_.extent().height}},
                           .layerCount = 1,
                           .colorAttachmentCount = 1,
                           .pColorAttachments = &color});
  if (!draws_.empty()) draw(commands, frame, eye);
  commands.endRendering();
  return texels;
}

void ShadingPass::reserve(Frame& frame, std::size_t patches) {
  const std::size_t corner_bytes = patches * kMaxPatchCorners * sizeof(Corner);
  if (frame.corners.has_value() && frame.corners->size() >= corner_bytes) return;
  const std::size_t room = std::bit_ceil(std::max<std::size_t>(patches, 1024));
  frame.corners.emplace(*device_, BufferSettings{.name = "shading corners",
                                                 .size = room * kMaxPatchCorners * sizeof(Corner),
                                                 .usage = vk::BufferUsageFlagBits::eVertexBuffer,
                                                 .residence = Residence::kUpload});
  frame.indices.emplace(*device_, BufferSettings{.name = "shading indices",
                                                 .size = room * kMaxIndices * sizeof(std::uint32_t),
                                                 .usage = vk::BufferUsageFlagBits::eIndexBuffer,
                                                 .residence = Residence::kUpload});
}

std::uint64_t ShadingPass::write_geometry(Frame& frame, std::span<const PlacedPatch> patches) {
  const Scene& scene = scene_->scene();
  Corner* const corners = frame.corners->mapped<Corner>().data();
  std::uint32_t* const indices = frame.indices->mapped<std::uint32_t>().data();
  std::uint32_t corner_at = 0;
  std::uint32_t index_at = 0;
  std::uint64_t texels = 0;
  draws_.clear();
  for (const PlacedPatch& placed : patches) {
    const std::uint32_t id = value(placed.patch);
    AW_ASSERT(id < scene.patches.size());
    const Patch& patch = scene.patches[id];
    const std::uint32_t lights = scene_->lights().of_patch[id];
    if (draws_.empty() || draws_.back().material != patch.material) {
      draws_.push_back({patch.material, index_at, 0});
    }
    const BlockFrame place(placed.block);
    const std::uint32_t first_corner = corner_at;
    for (std::uint32_t c = 0; c < corner_count(patch.triangles); ++c) {
      const auto [u, v] = corner_coordinate(patch.triangles, c);
      corners[corner_at++] = place.corner(patch.vertices[c], lights, u, v);
    }
    std::uint32_t triangles = patch.triangles;
    if (triangles == 1) {
      corners[corner_at++] = place.corner(scene_->fourth_corner(placed.patch), lights, 1.0F, 1.0F);
      for (const std::uint32_t c : {0U, 1U, 2U, 2U, 1U, 3U}) indices[index_at++] = first_corner + c;
    } else {
      for (std::uint32_t t = 0; t < triangles; ++t) {
        for (const std::uint8_t c : patch_triangle(triangles, t)) indices[index_at++] = first_corner + c;
      }
    }
    draws_.back().index_count += 3 * drawn_triangles(triangles);
    texels += placed.block.area();
  }
  frame.corners->flush();
  frame.indices->flush();
  return texels;
}

void ShadingPass::draw(const vk::raii::CommandBuffer& commands, const Frame& frame, const glm::dvec3& eye) {
  const Scene& scene = scene_->scene();
  gpu_layout::DrawConstants constants{};
  split(eye - scene.origin, constants.camera_high, constants.camera_low);
  constants.clip_from_texel = {2.0F / static_cast<float>(atlas_.extent().width),
                               2.0F / static_cast<float>(atlas_.extent().height)};
  set_viewport(commands, atlas_.extent());
  commands.bindVertexBuffers(0, frame.corners->handle(), vk::DeviceSize{0});
  commands.bindIndexBuffer(frame.indices->handle(), 0, vk::IndexType::eUint32);
  std::size_t bound = MaterialPipelines::kNone;
  for (const Draw& d : draws_) {
    pipelines_.bind(commands, d.material, bound);
    if (bound == MaterialPipelines::kNone) pipelines_.push(commands, constants);
    bound = d.material;
    commands.drawIndexed(d.index_count, 1, d.first_index, 0, 0);
  }
}

}  // namespace atlaswire::render
