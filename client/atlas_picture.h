#pragma once

#include "base/units.h"
#include "codec/video.h"
#include "render/image/picture.h"

namespace atlaswire::client {

/// A decoded atlas as RGBA for people to look at: its colours only, BT.709 full range, chroma repeated.
/// `colors` lies inside the picture.
render::Picture atlas_picture(const codec::I420View& picture, Extent2D colors);

}  // namespace atlaswire::client
