#include "render/warp/view_warp.h"

#include "base/assert.h"
#include "base/program.h"
#include "render/display/atlas_texture.h"
#include "render/gpu/offscreen_target.h"
#include "render/gpu/pipeline.h"
#include "render/warp/pixel_transfer.h"
#include "shaders/shaders.h"
#include "shaders/warp_layout.h"

#include <algorithm>
#include <optional>

namespace atlaswire::render {
namespace {

ShaderWords fragment_of(WarpKind kind) {
  switch (kind) {
    case WarpKind::kTimeWarp:
      return shaders::warp_time_frag;
    case WarpKind::kMesh:
      return shaders::warp_mesh_frag;
    case WarpKind::kIterative:
      return shaders::warp_iterative_frag;
  }
  AW_ASSERT(false);
}

/// The whole screen and no depth, or a grid with a depth test that what is infinitely far passes too.
GraphicsSettings pipeline_settings(WarpKind kind, vk::DescriptorSetLayout layout,
                                   const IterativeSettings& iterative) {
  const bool mesh = kind == WarpKind::kMesh;
  GraphicsSettings s{
      .name = "warp",
      .vertex = mesh ? shaders::warp_mesh_vert : shaders::warp_screen_vert,
      .fragment = fragment_of(kind),
      .layouts = {layout},
      .push_constant_bytes = sizeof(gpu_layout::WarpConstants),
      .topology = mesh ? vk::PrimitiveTopology::eTriangleStrip : vk::PrimitiveTopology::eTriangleList,
      .colors = {vk::Format::eR8G8B8A8Unorm},
      .depth = vk::Format::eD32Sfloat,
      .depth_test = mesh,
      .depth_write = mesh,
      .depth_compare = vk::CompareOp::eGreaterOrEqual};
  if (kind == WarpKind::kIterative) s.specialization = {{0, iterative.iterations}, {1, iterative.starts}};
  return s;
}

gpu_layout::WarpConstants constants_of(const PixelTransfer& transfer, double largest_inverse,
                                       const Camera& source, const Camera& display) {
  const auto column = [&](int i) { return glm::vec4{glm::vec3{transfer.homography[i]}, 0.0F}; };
  return {.homography_x = column(0),
          .homography_y = column(1),
          .homography_1 = column(2),
          .parallax = glm::vec4{glm::vec3{transfer.parallax}, static_cast<float>(largest_inverse)},
          .source_extent = {source.extent.width, source.extent.height},
          .target_extent = {display.extent.width, display.extent.height},
          .near_plane = static_cast<float>(display.near_plane)};
}

/// A source's pixels on the device.
struct SourceTexture {
  AtlasTexture colors;
  Buffer inverse_distances;
  DescriptorSets sets;  ///< by slot of `colors`
  std::uint32_t slot = 0;

  SourceTexture(Device& device, const DescriptorLayout& layout, const vk::raii::Sampler& sampler,
                Extent2D extent)
      : colors(device, extent, false, 2),
        inverse_distances(device, {.name = "warp inverse distances",
                                   .size = extent.area() * sizeof(float),
                                   .usage = vk::BufferUsageFlagBits::eStorageBuffer,
                                   .residence = Residence::kUpload}),
        sets(device, "warp", layout, 2) {
    for (std::uint32_t i = 0; i < 2; ++i) {
      sets.write(i, 0, colors.image(i), sampler);
      sets.write(i, 1, inverse_distances);
    }
  }
};

class GpuViewWarp final : public ViewWarp {
 public:
  GpuViewWarp(WarpKind kind, Device& device, const glm::vec3& background, const IterativeSettings& iterative)
      : kind_(kind),
        background_(background),
        context_(device, "warp", 1),
        sampler_(make_sampler(device, {.name = "warp source"})),
        layout_(device, "warp",
                {{0, vk::DescriptorType::eCombinedImageSampler, vk::ShaderStageFlagBits::eFragment},
                 {1, vk::DescriptorType::eStorageBuffer,
                  vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment}}),
        pipeline_(device, pipeline_settings(kind, layout_.handle(), iterative)) {}

  void show(const WarpSource& source) override;
  void draw(const Camera& camera) override;
  const Picture& read_back() override;
  [[nodiscard]] OffscreenTarget* target() override { return target_.get(); }

 private:
  void upload_depth(std::span<const float> depth);
  void record(const vk::raii::CommandBuffer& commands, const Camera& camera) const;

  WarpKind kind_;
  glm::vec3 background_;
  SubmitContext context_;
  vk::raii::Sampler sampler_;
  DescriptorLayout layout_;
  Pipeline pipeline_;
  std::unique_ptr<SourceTexture> source_;  ///< of the last source's extent
  Camera camera_;                          ///< the shown source's
  float largest_inverse_ = 0.0F;           ///< of its distances
  std::unique_ptr<OffscreenTarget> target_;
  Picture picture_;
};

void GpuViewWarp::show(const WarpSource& source) {
  const Extent2D extent = source.camera.extent;
  AW_ASSERT(source.colors.extent == extent);
  if (source_ == nullptr || source_->colors.colors() != extent) {
    source_ = std::make_unique<SourceTexture>(context_.device(), layout_, sampler_, extent);
  }
  camera_ = source.camera;
  source_->slot = source_->colors.upload(source.colors);
  if (kind_ == WarpKind::kTimeWarp) return;
  AW_ASSERT(source.depth.size() == extent.area());
  upload_depth(source.depth);
}

void GpuViewWarp::upload_depth(std::span<const float> depth) {
  const auto inverse = source_->inverse_distances.mapped<float>();
  largest_inverse_ = 0.0F;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    inverse[i] = 1.0F / depth[i];
    largest_inverse_ = std::max(largest_inverse_, inverse[i]);
  }
  source_->inverse_distances.flush();
}

void GpuViewWarp::draw(const Camera& camera) {
  AW_ASSERT(source_ != nullptr);
  if (camera.extent.area() == 0) return;
  fit_target(target_, context_.device(), "warp", camera.extent);
  context_.run([&](const vk::raii::CommandBuffer& commands) {
    target_->begin(commands, background_);
    record(commands, camera);
    commands.endRendering();
  });
}

void GpuViewWarp::record(const vk::raii::CommandBuffer& commands, const Camera& camera) const {
  const bool mesh = kind_ == WarpKind::kMesh;
  const PixelTransfer transfer = mesh ? pixel_transfer(camera_, camera) : pixel_transfer(camera, camera_);
  pipeline_.bind(commands, {source_->sets.handle(source_->slot)});
  pipeline_.push(commands, constants_of(transfer, largest_inverse_, camera_, camera));
  if (mesh) {
    commands.draw(2 * (camera_.extent.width + 2), camera_.extent.height + 1, 0, 0);
  } else {
    commands.draw(3, 1, 0, 0);
  }
}

const Picture& GpuViewWarp::read_back() {
  if (target_ != nullptr) render::read_back(context_, *target_, picture_);
  return picture_;
}

}  // namespace

std::unique_ptr<ViewWarp> make_view_warp(WarpKind kind, Device& device, const glm::vec3& background,
                                         const IterativeSettings& iterative) {
  if (iterative.iterations < 1 || iterative.starts < 2) {
    throw ProgramError(ExitCode::kUsage, "iterative warp: at least one iteration and two starts");
  }
  return std::make_unique<GpuViewWarp>(kind, device, background, iterative);
}

}  // namespace atlaswire::render
