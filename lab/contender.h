#pragma once

#include "client/arrival.h"
#include "lab/point.h"
#include "proto/frame_assembler.h"
#include "proto/stream_description.h"
#include "render/camera.h"
#include "render/gpu/open_device.h"
#include "render/image/lens_correction.h"
#include "render/image/picture.h"
#include "render/scene/scene.h"
#include "server/encoded_frame.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace atlaswire::lab {

/// A streaming method with both of its ends, driven by whoever owns virtual time: the server's end makes
/// frames, the client's end takes what a network delivered of them and redraws the newest whole frame for any
/// pose. One thread.
class Contender {
 public:
  virtual ~Contender() = default;

  /// The server's end.
  virtual server::FrameMaker& maker() = 0;
  /// What a client is told before its first frame.
  [[nodiscard]] virtual const proto::StreamDescription& description() const = 0;

  /// The client's end: a picture and an update, in the order of arrival.
  virtual void on_frame(const proto::AssembledFrame& frame) = 0;
  virtual void on_update(const client::UpdateArrival& update) = 0;
  /// Puts the newest whole frame on display; nullopt when there is no newer one than last time.
  virtual std::optional<FrameId> show_newest() = 0;
  /// The frame on display, redrawn for `eye` and corrected for its lens; alpha 0 where nothing was drawn.
  /// Valid until the next call.
  /// Only after a first show_newest() gave a frame.
  virtual const render::Picture& draw(const render::Camera& eye) = 0;
  /// A picture did not decode since the last call: the server must be asked for an I-frame.
  virtual bool take_refresh() = 0;
};

/// The contender that `settings.method` names. `scene` and `device` as for a daemon. Throws ProgramError for
/// an unknown method, listing the known.
std::unique_ptr<Contender> make_contender(const PointSettings& settings, render::Device& device,
                                          std::shared_ptr<const render::Scene> scene);

/// The display's camera at the identity pose: one eye's.
render::Camera display_camera(const PointSettings& settings);
/// What pictures of the display are corrected for. Throws ProgramError for a text that is no lens.
render::LensCorrection display_lens(const PointSettings& settings);

}  // namespace atlaswire::lab
