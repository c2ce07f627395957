#pragma once

#include "render/scene/scene.h"
#include "shaders/scene_layout.h"

#include <cstdint>
#include <vector>

namespace atlaswire::render {

/// A scene's lights as the shaders read them: at most gpu_layout::kMaxLights with a
/// dark one at 0, and lists of those that reach
/// each chunk (for the forward pass) and each patch (for the shading pass, which draws patches anyway).
struct LightTable {
  std::vector<gpu_layout::LightConstants> lights;
  /// Lists behind each other, each its count and then indices into `lights`. The first stands for "none": it
  /// names light 0, which is dark, because the shader's loop runs at least once.
  std::vector<std::uint32_t> lists{1, 0};
  std::vector<std::uint32_t> of_chunk;  ///< where in `lists` each chunk's begins
  std::vector<std::uint32_t> of_patch;  ///< and each patch's
  std::uint32_t dropped = 0;            ///< lights left out
  bool spots = false;                   ///< any of them is a spot light

  /// Some list names a light.
  [[nodiscard]] bool used() const { return lists.size() > 2; }
};

/// Packs them. Of more lights than fit, those of greatest intensity times range stay. A patch's list leaves
/// out only lights that add exactly nothing to it: out of range, or behind all of its interpolated normals.
LightTable make_light_table(const Scene& scene);

}  // namespace atlaswire::render
