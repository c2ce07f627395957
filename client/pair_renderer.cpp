#include "client/pair_renderer.h"

#include "render/display/atlas_texture.h"
#include "render/display/display_mesh.h"
#include "render/display/display_pass.h"
#include "render/gpu/device.h"

#include <algorithm>

namespace atlaswire::client {
namespace {

render::I420Planes planes_of(const codec::I420View& v) {
  return {.extent = v.extent, .y = v.y, .u = v.u, .v = v.v, .y_stride = v.y_stride, .uv_stride = v.uv_stride};
}

}  // namespace

struct PairRenderer::Parts {
  Parts(render::Device& device, const proto::StreamDescription& stream)
      : atlas(device, stream.atlas, stream.has_coverage),
        mesh(device),
        pass(device, atlas, {stream.background[0], stream.background[1], stream.background[2]}) {}

  render::AtlasTexture atlas;
  render::DisplayMesh mesh;
  render::DisplayPass pass;
  std::uint32_t slot = 0;
};

PairRenderer::PairRenderer(render::Device& device, const proto::StreamDescription& stream)
    : parts_(std::make_unique<Parts>(device, stream)) {}
PairRenderer::~PairRenderer() = default;

void PairRenderer::show(const Pair& pair) {
  parts_->slot = parts_->atlas.upload(planes_of(pair.picture->view()));
  parts_->mesh.assign(pair.mesh, pair.origin);
}

void PairRenderer::draw(const render::Camera& camera) {
  parts_->pass.draw(parts_->mesh, parts_->slot, camera);
}

const render::Picture& PairRenderer::read_back() { return parts_->pass.read_back(); }

}  // namespace atlaswire::client
