#pragma once

#include "render/atlas/allocator.h"
#include "render/camera.h"
#include "render/display/display_pass.h"
#include "render/passes/forward.h"
#include "render/passes/i420_pass.h"
#include "render/passes/shading.h"
#include "render/passes/tonemap.h"

#include <memory>
#include <vector>

namespace atlaswire::render::test {

/// Server and client pixels without what lies between: shade, convert to I420, upload, display.
class RoundTrip {
 public:
  RoundTrip(Device& device, std::shared_ptr<const Scene> scene, Extent2D atlas)
      : device_(device),
        scene_(std::move(scene)),
        gpu_(device, scene_),
        shading_(device, gpu_, atlas, 2),
        forward_(device, gpu_),
        i420_(device, shading_.atlas(),
              scene_->requirements.alpha() ? I420Pass::LowerHalf::kCoverage : I420Pass::LowerHalf::kNone, 2),
        texture_(device, atlas, scene_->requirements.alpha()),
        mesh_(device),
        display_(device, texture_, display_color(scene_->background, scene_->exposure)) {}

  /// What a client shows at `camera` of patches shaded for it.
  Picture display(const std::vector<PlacedPatch>& placed, const Camera& camera) {
    SubmitContext context(device_, "round trip");
    context.run([&](const vk::raii::CommandBuffer& commands) {
      shading_.record(commands, placed, camera.pose.position, true);
      use_image(commands, shading_.atlas(), ImageUse::kSampledInCompute);
      i420_.record(commands, 0);
    });
    const I420Picture p = i420_.picture(0);
    const std::uint32_t slot = texture_.upload({p.extent, p.y, p.u, p.v, p.extent.width, p.extent.width / 2});
    std::vector<DisplayPatch> patches;
    for (const PlacedPatch& one : placed) {
      const Patch& patch = scene_->patches[value(one.patch)];
      DisplayPatch to{patch.triangles, scene_->materials[patch.material].draw, one.block, {}};
      for (std::size_t c = 0; c < kMaxPatchCorners; ++c) {
        to.positions[c] = scene_->vertices[patch.vertices[c]].position;
      }
      patches.push_back(to);
    }
    MeshData data;
    build_mesh(patches, data);
    mesh_.assign(data, scene_->origin);
    display_.draw(mesh_, slot, camera);
    return display_.read_back();
  }

  Picture forward(const Camera& camera) { return forward_.render(camera); }

 private:
  Device& device_;
  std::shared_ptr<const Scene> scene_;
  SceneGpu gpu_;
  ShadingPass shading_;
  ForwardPass forward_;
  I420Pass i420_;
  AtlasTexture texture_;
  DisplayMesh mesh_;
  DisplayPass display_;
};

}  // namespace atlaswire::render::test
