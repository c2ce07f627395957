#pragma once

#include "render/scene/scene.h"
#include "shaders/scene_layout.h"

#include <cstdint>
#include <vector>

namespace atlaswire::render {

/// A scene's lights as the shaders read them: at most gpu_layout::kMaxLights, and each chunk's list as
/// indices into them.
struct LightTable {
  struct Range {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  std::vector<gpu_layout::LightConstants> lights;
  std::vector<std::uint32_t> list;
  std::vector<Range> chunk_ranges;  ///< into `list`, one a chunk
  std::uint32_t dropped = 0;        ///< lights left out
  bool spots = false;               ///< any of them is a spot light
};

/// Packs them. Of more lights than fit, those of greatest intensity times range stay.
LightTable make_light_table(const Scene& scene);

}  // namespace atlaswire::render
