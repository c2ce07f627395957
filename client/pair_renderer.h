#pragma once

#include "client/pair.h"
#include "proto/stream_description.h"
#include "render/camera.h"
#include "render/gpu/open_device.h"
#include "render/image/lens_correction.h"
#include "render/image/picture.h"

#include <memory>

namespace atlaswire::client {

/// What the viewer wears.
struct Headset {
  double ipd = 0;  ///< metres between the eyes; 0: one eye, at the head's pose
  render::LensCorrection lens;
};

/// The display stage ([SAS] 3.6) on a device: shows one pair, redraws it for any camera. One thread.
class PairRenderer {
 public:
  /// Draws once for `camera`, so that the first pair does not wait for pipelines to compile.
  PairRenderer(render::Device& device, const proto::StreamDescription& stream, const render::Camera& camera,
               const Headset& headset = {});
  ~PairRenderer();

  /// Switches to this pair's atlas and vertex buffer.
  void show(const Pair& pair);
  /// Draws the shown pair for a head and waits for the picture: `head.extent` an eye, side by side, corrected
  /// for the lenses.
  void draw(const render::Camera& head);
  /// The last picture drawn; alpha 0 where nothing was. Valid until the next draw or reading.
  [[nodiscard]] const render::Picture& read_back();
  /// The camera that quality is measured with: the left eye's, or the head's if there is one eye.
  [[nodiscard]] render::Camera measured_camera(const render::Camera& head) const;
  /// What an eye sees of the shown pair through no lens, drawn and read.
  [[nodiscard]] const render::Picture& draw_undistorted(const render::Camera& eye);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace atlaswire::client
