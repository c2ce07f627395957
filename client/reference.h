#pragma once

#include "base/units.h"
#include "client/quality.h"
#include "client/sample.h"
#include "render/gpu/open_device.h"
#include "render/scene/scene.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace atlaswire::client {

/// Renders ground truth for each sample's camera and scene time and compares ([SAS] 5.6). Stops early, with
/// what it has, when `should_stop` says so.
class Reference {
 public:
  Reference(render::Device& device, std::shared_ptr<const render::Scene> scene);
  ~Reference();

  std::vector<Quality> compare(const std::vector<Sample>& samples, const std::function<bool()>& should_stop);
  /// Ground truth, the client's view and the atlas that it was drawn from, side by side with captions.
  render::Picture triptych(const Sample& sample, const Quality& quality, Extent2D atlas);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace atlaswire::client
