#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace atlaswire::render {

/// What a scene demands of the renderer, found at load. Pipelines, passes, buffers and message fields exist
/// only where it says so; `atlasd --explain-scene` prints it.
struct SceneRequirements {
  bool alpha_mask = false;
  bool alpha_blend = false;
  bool double_sided = false;
  bool base_color_textures = false;
  bool normal_maps = false;
  bool metallic_roughness_textures = false;
  bool emissive = false;
  bool sun = false;  ///< and so its shadow map
  std::uint32_t lights = 0;
  std::uint32_t most_lights_per_chunk = 0;
  std::uint32_t triangles = 0;
  std::uint32_t patches_of[4] = {0, 0, 0, 0};  ///< patches with 1, 2, 3 triangles at [1], [2], [3]
  std::uint32_t degenerate_triangles = 0;      ///< dropped at load
  std::uint32_t split_triangles = 0;  ///< added at load by splitting huge ones, each mesh counted once
  // Of what moves (scene_motion.h).
  std::uint32_t clips = 0;
  std::uint32_t rigid_objects = 0;
  std::uint32_t deformed_parts = 0;
  std::uint32_t deformed_points = 0;
  /// The atlas needs a coverage plane beside its colours.
  [[nodiscard]] bool alpha() const { return alpha_mask || alpha_blend; }
};

/// Lines for people: each feature, on or off, and why.
std::vector<std::string> explain(const SceneRequirements& requirements);

}  // namespace atlaswire::render
