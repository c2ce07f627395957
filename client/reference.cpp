#include "client/reference.h"

#include "client/atlas_picture.h"
#include "render/gpu/device.h"
#include "render/image/compose.h"
#include "render/passes/forward.h"
#include "render/passes/scene_gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace atlaswire::client {
namespace {

/// As a viewer sees it: the scene's background where nothing was drawn.
render::Picture opaque(render::Picture picture) {
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = 255;
  return picture;
}

}  // namespace

struct Reference::Parts {
  render::Picture truth(const Sample& sample) {
    if (sample.scene_time) scene.move_to(to_seconds(*sample.scene_time));
    return forward.render(sample.camera);
  }

  Parts(render::Device& device, std::shared_ptr<const render::Scene> s)
      : scene(device, std::move(s)), forward(device, scene) {}
  render::SceneGpu scene;
  render::ForwardPass forward;
};

Reference::Reference(render::Device& device, std::shared_ptr<const render::Scene> scene)
    : parts_(std::make_unique<Parts>(device, std::move(scene))) {}
Reference::~Reference() = default;

std::vector<Quality> Reference::compare(const std::vector<Sample>& samples,
                                        const std::function<bool()>& should_stop) {
  std::vector<Quality> all;
  for (const Sample& sample : samples) {
    if (should_stop()) break;
    Quality q = client::compare(parts_->truth(sample), sample.view);
    q.frame = sample.frame;
    q.display_index = sample.display_index;
    all.push_back(q);
  }
  return all;
}

render::Picture Reference::triptych(const Sample& sample, const Quality& quality, Extent2D atlas) {
  const render::Picture truth = opaque(parts_->truth(sample));
  const render::Picture view = opaque(sample.view);
  const std::uint32_t height = sample.camera.extent.height;
  const auto width = static_cast<std::uint32_t>(std::uint64_t{atlas.width} * height / atlas.height);
  const render::Picture shading =
      render::resized_nearest(atlas_picture(sample.atlas->view(), atlas), {std::max(width, 1U), height});
  const std::array panels{
      render::Panel{.image = &truth, .label = "ground truth"},
      render::Panel{
          .image = &view,
          .label = fmt::format("client view, MSSIM {:.3f}, PSNR {:.1f} dB", quality.mssim, quality.psnr)},
      render::Panel{.image = &shading, .label = fmt::format("atlas {}x{}", atlas.width, atlas.height)}};
  return render::side_by_side(panels);
}

}  // namespace atlaswire::client
