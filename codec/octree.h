#pragma once

#include "base/grid.h"
#include "codec/bit_io.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace atlaswire::codec {

/// Where a point comes in the order of an octree over the grid: the bits of x, y and z by turns, the highest
/// first, x the highest of three. Coordinates must be below 2^21.
std::uint64_t octree_order(const GridPosition& at);

/// Writes points as an octree over a grid of 2^bits cells a side ([SAS] 6.5 after Botsch et al. 2002: which
/// of its eight children each node has). docs/PROTOCOL.md, "Octree". Points must be in octree order; some
/// may be equal. Nothing is written of no points.
void write_octree(std::span<const GridPosition> points, std::uint32_t bits, BitWriter& out);

/// `count` points in octree order. nullopt: no octree of so many points. Takes memory for `count` points, and
/// time for them and for the bits read.
std::optional<std::vector<GridPosition>> read_octree(BitReader& in, std::uint32_t count, std::uint32_t bits);

}  // namespace atlaswire::codec
