#pragma once

#include "render/scene/source.h"

#include <cstdint>
#include <vector>

namespace atlaswire::render {

/// The atrium's materials by what they are put on; values index SceneSource::materials.
enum class AtriumMaterial : std::uint16_t {
  kFloor,
  kGallery,
  kWall,
  kUpperWall,
  kColumn,
  kArch,
  kMoulding,
  kCeiling,
  kBalustrade,
  kPlinth,
  kWater,
  kBronze,
  kVaseGlazed,
  kVasePainted,
  kCurtainRed,
  kCurtainBlue,
  kCurtainGreen,
  kCurtainOchre,
  kIvy,
};

/// Appends all of them, with their textures, in the order above. Deterministic.
void add_atrium_materials(SceneSource& source);

}  // namespace atlaswire::render
