#pragma once

#include "render/scene/flatten.h"
#include "render/scene/patch_grouping.h"
#include "render/scene/scene.h"

#include <cstdint>
#include <vector>

namespace atlaswire::render {

/// Where a group of triangles comes in the order of drawing.
struct OrderedGroup {
  std::uint32_t group = 0;  ///< into the groups given
  std::uint32_t patch = 0;  ///< its number in the scene
  std::uint32_t chunk = 0;  ///< counted from 0, ascending
  std::uint16_t material = 0;
};

/// Orders groups by draw class, material and the instance that moves them (none first), and within each such
/// run numbers them by a walk over the surface (walk_order.h) and cuts them into compact chunks: the box of
/// their centres is halved along its longest side until at most `most_triangles` are left. Against runs along
/// a Morton curve the boxes have about half the surface, so fewer are in view and fewer lights reach each.
/// Numbers ascend within a chunk; a run has the same places in both orders.
std::vector<OrderedGroup> order_by_chunk(const FlatMesh& flat, const std::vector<TriangleGroup>& groups,
                                         const std::vector<Material>& materials,
                                         std::uint32_t most_triangles);

}  // namespace atlaswire::render
