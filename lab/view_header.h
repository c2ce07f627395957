#pragma once

#include "base/bytes.h"
#include "base/ids.h"
#include "render/camera.h"

#include <optional>

namespace atlaswire::lab {

/// What goes beside an ordinary picture so that a warp can use it: its camera, without velocities, and the
/// scale of its depth plane.
struct ViewHeader {
  FrameId frame{};
  render::Camera camera;
  double nearest = 0;  ///< metres; as render::RenderedView
};

/// 80 octets: frame u32; position 3 x f64, orientation (x, y, z, w) 4 x f64, vertical field of view f64,
/// width and height u16, near plane and `nearest` f32; big-endian.
ByteBuffer write_view_header(const ViewHeader& header);
/// nullopt for other lengths.
std::optional<ViewHeader> read_view_header(ByteView bytes);

}  // namespace atlaswire::lab
