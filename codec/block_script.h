#pragma once

#include "base/block.h"
#include "base/units.h"
#include "codec/gate_models.h"

#include <bit>
#include <cstdint>

namespace atlaswire::codec {

/// Where a block of known size lies, decision by decision, the same for both directions: in units of its
/// sides where it is aligned to them, the upper bits by its size. docs/PROTOCOL.md, "Block positions". False:
/// outside the atlas.
template <class Coder>
bool code_block_position(Coder& coder, GateModels& models, const Extent2D& atlas, Block& block) {
  const std::uint32_t unaligned = (block.x & (block.width() - 1)) | (block.y & (block.height() - 1));
  const bool aligned = coder.code(models.aligned, unaligned == 0);
  const auto code_axis = [&](AdaptiveTree<4>& upper, std::uint32_t at, std::uint32_t side_log2,
                             std::uint32_t extent) {
    const std::uint32_t unit = aligned ? side_log2 : 0;
    const auto bits = static_cast<std::uint32_t>(std::bit_width((extent - 1) >> unit));
    const std::uint32_t lower = bits > 4 ? bits - 4 : 0;
    const std::uint32_t top = upper.code(coder, at >> unit >> lower);
    const std::uint32_t rest = coder.code_raw(at >> unit & ((1U << lower) - 1), lower);
    return (top << lower | rest) << unit;
  };
  const std::uint32_t x = code_axis(models.block_x[block.width_log2], block.x, block.width_log2, atlas.width);
  const std::uint32_t y =
      code_axis(models.block_y[block.height_log2], block.y, block.height_log2, atlas.height);
  block.x = static_cast<std::uint16_t>(x);
  block.y = static_cast<std::uint16_t>(y);
  return x + block.width() <= atlas.width && y + block.height() <= atlas.height;
}

}  // namespace atlaswire::codec
