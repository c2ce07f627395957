#pragma once

#include "base/block.h"
#include "codec/gate_models.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>

namespace atlaswire::codec {

/// A number of -33..33.
template <class Coder>
std::int32_t code_offset(Coder& coder, OffsetModels& models, std::int32_t wanted) {
  if (!coder.code(models.off, wanted != 0)) return 0;
  const bool below = coder.code(models.below, wanted < 0);
  std::int32_t distance = 1;
  if (coder.code(models.far, std::abs(wanted) > 1)) {
    const auto further = static_cast<std::uint32_t>(std::abs(wanted)) - 2U;
    distance = 2 + static_cast<std::int32_t>(models.further.code(coder, further));
  }
  return below ? -distance : distance;
}

/// log2 of a block's texels.
inline std::int32_t area_of(const Block& block) { return block.width_log2 + block.height_log2; }

/// log2 of width over height as a patch sees it: below 0 where it is mirrored.
inline std::int32_t stretch_of(const Block& block) {
  const std::int32_t stretch = block.width_log2 - block.height_log2;
  return block.transposed ? -stretch : stretch;
}

/// Where a block stands against another that both ends know: size and mirroring, decision by decision.
/// nullopt: no legal block came out. Position is not touched.
template <class Coder>
std::optional<Block> code_level(Coder& coder, LevelModels& models, const Block& reference,
                                const Block* wanted) {
  constexpr std::int32_t kMostLog2 = 15;
  const std::int32_t old_area = area_of(reference);
  const std::int32_t old_stretch = stretch_of(reference);
  const std::int32_t grown = code_offset(coder, models.area[static_cast<std::size_t>(std::min(old_area, 15))],
                                         wanted == nullptr ? 0 : area_of(*wanted) - old_area);
  const std::int32_t area = old_area + grown;
  // A stretch has its area's parity: where that changes, the next wider one is what it is measured from.
  const std::int32_t nearest = old_stretch + (grown & 1);
  const std::int32_t went = grown < 0 ? 0 : grown == 0 ? 1 : 2;
  const std::int32_t context =
      (went * 7 + std::clamp(old_stretch, -3, 3) + 3) * 4 + std::min(old_area, 7) / 2;
  const std::int32_t stretch =
      nearest + 2 * code_offset(coder, models.stretch[static_cast<std::size_t>(context)],
                                wanted == nullptr ? 0 : (stretch_of(*wanted) - nearest) / 2);
  const std::int32_t width = (area + std::abs(stretch)) / 2;
  if (area < std::abs(stretch) || width > kMostLog2) return std::nullopt;
  Block block = reference;
  block.width_log2 = static_cast<std::uint8_t>(width);
  block.height_log2 = static_cast<std::uint8_t>(area - width);
  block.transposed = stretch < 0;
  if (stretch == 0) {
    AdaptiveBit& mirrored = models.mirrored_square[reference.transposed ? 1 : 0];
    block.transposed = coder.code(mirrored, wanted != nullptr && wanted->transposed);
  }
  return block;
}

}  // namespace atlaswire::codec
