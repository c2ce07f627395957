#pragma once

#include "base/block.h"
#include "base/patch_layout.h"

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace atlaswire::render {

/// A pre-shaded patch to draw: what a client's replica knows of it. Positions are relative to any one
/// origin of the caller's choice; the first corner_count(triangles) count.
struct DisplayPatch {
  std::uint8_t triangles = 1;  ///< 1..3
  PatchClass draw;
  Block block;
  std::array<glm::vec3, kMaxPatchCorners> positions{};
};

/// A vertex as shaders/display.vert reads it.
struct DisplayVertex {
  glm::vec3 position;
  std::uint16_t half_texel_x;  ///< atlas coordinate in half texels: exact for every corner_texel
  std::uint16_t half_texel_y;
};
static_assert(sizeof(DisplayVertex) == 16);

/// Patches as one vertex and one index array, grouped by how they are drawn.
struct MeshData {
  struct Range {
    std::uint32_t first = 0;  ///< into `indices`
    std::uint32_t count = 0;
  };
  /// A blended patch: drawn after all others, in the order of distance.
  struct Blended {
    glm::vec3 centre{0.0F};  ///< mean of its corners
    Range range;
    bool double_sided = false;
  };

  std::vector<DisplayVertex> vertices;
  std::vector<std::uint32_t> indices;
  /// Of opaque and masked patches, [alpha class][double-sided]; blended ones are in `blended`.
  std::array<std::array<Range, 2>, 2> solid{};
  std::vector<Blended> blended;
};

/// Fills `mesh` from patches in any order, reusing its memory: allocates nothing once it is large enough.
/// Blocks must lie below texel 32767.
void build_mesh(std::span<const DisplayPatch> patches, MeshData& mesh);

}  // namespace atlaswire::render
