#pragma once

#include "render/passes/move_staging.h"
#include "render/scene/moved_scene.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace atlaswire::render {

/// The vertex that completes a patch of one triangle to a parallelogram.
ShadingVertex fourth_corner(const ShadingVertex& a, const ShadingVertex& b, const ShadingVertex& c);

/// Keeps a scene's shading vertices on the device where its moving parts are: Scene::vertices, then a fourth
/// corner for each patch of one triangle.
class MovedVertices {
 public:
  /// `solos`: patches of one triangle, ascending.
  MovedVertices(const Device& device, const Scene& scene, std::span<const std::uint32_t> solos);

  /// Records copies of the parts that moved since the last call. False: none did.
  bool record(const vk::raii::CommandBuffer& commands, const Scene& scene, const MovedScene& moved,
              const Buffer& vertices);

 private:
  struct Part {
    std::uint64_t version = 0;         ///< on the device
    std::uint32_t first_corner = 0;    ///< of its fourth corners, as vertices are numbered
    std::vector<std::uint32_t> solos;  ///< its patches of one triangle
  };
  std::vector<Part> parts_;
  MoveStaging staging_;
  std::vector<ShadingVertex> corners_;
};

}  // namespace atlaswire::render
