#pragma once

#include "render/scene/source.h"

#include <cstdint>

namespace atlaswire::render {

/// How much of each moves in the parade, 0..64 each, at least one in all.
struct ParadeOptions {
  std::uint32_t figures = 1;   ///< that walk in a circle: skinned, 11 joints, about 3000 vertices each
  std::uint32_t cloths = 1;    ///< that wave on a pole: 4 morph targets, 1225 vertices each
  std::uint32_t orbiters = 8;  ///< solids that circle and spin as rigid objects; every fourth rests
};

/// A built-in scene where things move: its rig has one clip of 8 seconds that joins its own beginning. A
/// floor of 12 x 12 m at y = 0. Joints have linear keys at 24 a second, as exported animations do; the
/// figures' ways are cubic splines.
SceneSource make_parade(const ParadeOptions& options = {});

}  // namespace atlaswire::render
