#pragma once

#include "base/block.h"
#include "codec/gate_models.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace atlaswire::codec {

/// Where a block stands against another that both ends know: size and mirroring, decision by decision.
/// nullopt: no legal block came out. Position is not touched.
template <class Coder>
std::optional<Block> code_level(Coder& coder, LevelModels& models, const Block& reference,
                                const Block* wanted) {
  const auto is_same = [&] {
    return wanted->width_log2 == reference.width_log2 && wanted->height_log2 == reference.height_log2 &&
           wanted->transposed == reference.transposed;
  };
  if (coder.code(models.same, wanted != nullptr && is_same())) return reference;
  Block block = reference;
  const std::uint32_t width =
      models.width[reference.width_log2 & 15U].code(coder, wanted ? wanted->width_log2 : 0U);
  const std::uint32_t went = width < reference.width_log2 ? 0 : width == reference.width_log2 ? 1 : 2;
  const std::uint32_t height =
      models.height[went * 16 + (reference.height_log2 & 15U)].code(coder, wanted ? wanted->height_log2 : 0U);
  const bool resized = width != reference.width_log2 || height != reference.height_log2;
  const std::size_t mirrored =
      2 * static_cast<std::size_t>(reference.transposed) + static_cast<std::size_t>(resized);
  block.transposed = coder.code(models.transposed[mirrored], wanted != nullptr && wanted->transposed);
  block.width_log2 = static_cast<std::uint8_t>(width);
  block.height_log2 = static_cast<std::uint8_t>(height);
  if (height > width) return std::nullopt;
  return block;
}

}  // namespace atlaswire::codec
