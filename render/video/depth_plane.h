#pragma once

#include "render/display/i420_planes.h"

#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::render {

/// Depth as the lower half of a video picture: one octet of luma a pixel, in proportion to inverse distance,
/// value = round(255 nearest / z), 0 where nothing was drawn (or farther than 510 nearest); chroma is 128.
///
/// Inverse distance is what a warp moves pixels by, so equal steps move them by equal steps. The error of
/// rounding is at most 1/510 of 1/nearest: at distance z that is z^2 / (510 nearest) metres, 2 cm at 1 m and
/// 0.5 m at 5 m where the nearest surface is at 0.1 m; and a viewer who moved sideways by d metres sees a
/// pixel off by at most focal d / (510 nearest) pixels. What the encoder loses comes on top of it.

/// The nearest distance that a plane is made with: `nearest` rounded down to a power of 2^(1/4), so that
/// small moves of the viewer do not change every value of the plane, and a P-frame finds it where it was.
double depth_plane_nearest(double nearest);

/// Writes distances (metres, > 0, infinity: nothing) as luma of equal size. `nearest` > 0 is at most the
/// least.
void encode_depth_plane(std::span<const float> depth, double nearest, std::span<std::uint8_t> luma);

/// Colours of a picture that has a depth plane below them.
I420Planes upper_half(const I420Planes& picture);

/// Distances in metres, rows from the top, of the depth plane of a picture: infinity for 0. `nearest` as in
/// RenderedView, > 0; any octets are fine.
void decode_depth_plane(const I420Planes& picture, double nearest, std::vector<float>& depth);

}  // namespace atlaswire::render
