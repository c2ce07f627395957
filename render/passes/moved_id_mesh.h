#pragma once

#include "render/passes/move_staging.h"
#include "render/passes/visibility_geometry.h"
#include "render/scene/moved_scene.h"

#include <cstdint>
#include <vector>

namespace atlaswire::render {

/// Keeps what the visibility passes read of a scene where its moving parts are.
class MovedIdMesh {
 public:
  MovedIdMesh(const Device& device, const Scene& scene);

  /// Records copies of the parts that moved since the last call.
  void record(const vk::raii::CommandBuffer& commands, const MovedScene& moved,
              const VisibilityGeometry& geometry);

 private:
  /// A part's vertices, of one kind: patches and texture coordinates stay as they are.
  struct Part {
    std::uint64_t version = 0;  ///< on the device
    std::uint32_t first = 0;
    std::vector<std::uint32_t> sources;
    std::vector<IdVertex> solid;
    std::vector<CutVertex> cut;
  };
  MovedIdMesh(const Device& device, const Scene& scene, IdMesh mesh);

  std::vector<Part> parts_;
  MoveStaging staging_;
};

}  // namespace atlaswire::render
