#pragma once

#include "client/pair.h"
#include "proto/stream_description.h"
#include "render/camera.h"
#include "render/gpu/open_device.h"
#include "render/image/picture.h"

#include <memory>

namespace atlaswire::client {

/// The display stage ([SAS] 3.6) on a device: shows one pair, redraws it for any camera. One thread.
class PairRenderer {
 public:
  /// Draws once for `camera`, so that the first pair does not wait for pipelines to compile.
  PairRenderer(render::Device& device, const proto::StreamDescription& stream, const render::Camera& camera);
  ~PairRenderer();

  /// Switches to this pair's atlas and vertex buffer.
  void show(const Pair& pair);
  /// Draws the shown pair and waits for the picture.
  void draw(const render::Camera& camera);
  /// The last picture drawn; alpha 0 where nothing was. Valid until the next call of `draw` or this.
  [[nodiscard]] const render::Picture& read_back();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace atlaswire::client
