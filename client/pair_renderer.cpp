#include "client/pair_renderer.h"

#include "render/display/atlas_texture.h"
#include "render/display/display_mesh.h"
#include "render/display/display_pass.h"
#include "render/display/lens_pass.h"
#include "render/gpu/device.h"
#include "render/passes/tonemap.h"

#include <optional>
#include <vector>

namespace atlaswire::client {
namespace {

render::I420Planes planes_of(const codec::I420View& v) {
  return {.extent = v.extent, .y = v.y, .u = v.u, .v = v.v, .y_stride = v.y_stride, .uv_stride = v.uv_stride};
}

/// One triangle in front of the camera, drawn in every way that the stream's scene may ask for.
render::MeshData warm_up_mesh(const proto::StreamDescription& stream) {
  using Alpha = PatchClass::Alpha;
  render::MeshData mesh;
  mesh.vertices = {{{-0.5F, -0.5F, -2.0F}, 1, 1}, {{0.5F, -0.5F, -2.0F}, 3, 1}, {{0.0F, 0.5F, -2.0F}, 1, 3}};
  mesh.indices = {0, 1, 2};
  const render::MeshData::Range all{.first = 0, .count = 3};
  for (const bool double_sided : {false, true}) {
    if (double_sided && !stream.double_sided) break;
    mesh.solid[static_cast<std::size_t>(Alpha::kOpaque)][double_sided ? 1 : 0] = all;
    if (stream.alpha_mask) mesh.solid[static_cast<std::size_t>(Alpha::kMask)][double_sided ? 1 : 0] = all;
    if (stream.alpha_blend) {
      mesh.blended.push_back({.centre = {0, 0, -2}, .range = all, .double_sided = double_sided});
    }
  }
  return mesh;
}

}  // namespace

struct PairRenderer::Parts {
  Parts(render::Device& device, const proto::StreamDescription& stream, const Headset& worn)
      : headset(worn),
        atlas(device, stream.atlas, stream.has_coverage),
        mesh(device),
        pass(device, atlas,
             render::display_color({stream.background[0], stream.background[1], stream.background[2]}, 1)) {
    const bool stereo = headset.ipd > 0;
    if (stereo || headset.lens != render::LensCorrection{})
      lens.emplace(device, headset.lens, stereo ? 2 : 1);
  }

  Headset headset;
  render::AtlasTexture atlas;
  render::DisplayMesh mesh;
  render::DisplayPass pass;
  std::optional<render::LensPass> lens;  ///< nullopt: one eye and no lens, so that the display is the pass's
  std::uint32_t slot = 0;
};

PairRenderer::PairRenderer(render::Device& device, const proto::StreamDescription& stream,
                           const render::Camera& camera, const Headset& headset)
    : parts_(std::make_unique<Parts>(device, stream, headset)) {
  const Extent2D extent = parts_->atlas.picture_extent();
  const std::vector<std::uint8_t> grey(extent.area(), 128);
  parts_->slot = parts_->atlas.upload({.extent = extent,
                                       .y = grey.data(),
                                       .u = grey.data(),
                                       .v = grey.data(),
                                       .y_stride = extent.width,
                                       .uv_stride = extent.width / 2});
  parts_->mesh.assign(warm_up_mesh(stream), {});
  render::Camera at_origin = camera;
  at_origin.pose = {};
  draw(at_origin);
}
PairRenderer::~PairRenderer() = default;

void PairRenderer::show(const Pair& pair) {
  parts_->slot = parts_->atlas.upload(planes_of(pair.picture->view()));
  parts_->mesh.assign(pair.mesh, pair.origin);
}

void PairRenderer::draw(const render::Camera& head) {
  Parts& p = *parts_;
  if (!p.lens) return p.pass.draw(p.mesh, p.slot, head);
  p.pass.draw(p.mesh, p.slot, measured_camera(head));
  p.lens->apply(*p.pass.target(), render::Eye::kLeft);
  if (p.headset.ipd > 0) {
    p.pass.draw(p.mesh, p.slot, render::eye_camera(head, render::Eye::kRight, p.headset.ipd));
    p.lens->apply(*p.pass.target(), render::Eye::kRight);
  }
}

const render::Picture& PairRenderer::read_back() {
  return parts_->lens ? parts_->lens->read_back() : parts_->pass.read_back();
}

render::Camera PairRenderer::measured_camera(const render::Camera& head) const {
  return render::eye_camera(head, render::Eye::kLeft, parts_->headset.ipd);
}

const render::Picture& PairRenderer::draw_undistorted(const render::Camera& eye) {
  parts_->pass.draw(parts_->mesh, parts_->slot, eye);
  return parts_->pass.read_back();
}

}  // namespace atlaswire::client
