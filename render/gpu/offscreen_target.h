#pragma once

#include "render/gpu/buffer.h"
#include "render/gpu/image.h"

#include <string>

namespace atlaswire::render {

/// What a picture is drawn into and read back from: RGBA8 colour, D32 depth, and a host buffer for the
/// colour.
struct OffscreenTarget {
  Image color;
  Image depth;
  Buffer readback;

  /// `name` leads the three objects' debug names.
  OffscreenTarget(const Device& device, const std::string& name, Extent2D extent);
};

}  // namespace atlaswire::render
