#pragma once

#include "base/result.h"
#include "render/scene/source.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace atlaswire::render {

/// The built-in scene: two storeys of columns and arches around a court, with curtains, vases and a fountain,
/// sun and lamps. About 30 x 16 x 12 m, the floor at y = 0.
struct AtriumOptions {
  double detail = 1;          ///< 0.02..2; triangles grow with it, about 250k at 1
  std::uint32_t lights = 16;  ///< lamps in the galleries, 0..400
  bool plants = false;        ///< alpha-masked ivy
};

/// "atrium", then options set off by colons: a detail, "lights=N", "plants". Error kBadName names the option.
Result<AtriumOptions> parse_atrium_name(std::string_view name);

SceneSource make_atrium(const AtriumOptions& options);

}  // namespace atlaswire::render
