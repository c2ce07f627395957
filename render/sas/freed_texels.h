#pragma once

#include "render/atlas/allocator.h"

#include <cstdint>
#include <vector>

namespace atlaswire::render {

/// A rectangle of texels.
struct TexelRect {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  auto operator<=>(const TexelRect&) const = default;
};

/// Follows an atlas's layout to know which texels patches gave up since the atlas was last cleaned, so that
/// an I-frame clears just those ([SAS] 4.2) and what is still shown need not be shaded again.
class FreedTexels {
 public:
  /// Nothing is held and nothing is dirty. `min_block_log2`: as in AllocatorSettings; it divides the sides.
  FreedTexels(Extent2D atlas, std::uint32_t min_block_log2, std::uint32_t patch_count);

  /// Follows one frame's change.
  void apply(const LayoutChange& change);

  /// What was given up since the last call and is held by nobody now: disjoint rectangles, top to bottom.
  [[nodiscard]] std::vector<TexelRect> take();

 private:
  enum class Cell : std::uint8_t { kClean, kHeld, kFreed };
  void fill(const Block& block, Cell state);

  std::uint32_t cell_log2_;
  Extent2D cells_;
  std::vector<Cell> states_;   ///< row by row
  std::vector<Block> blocks_;  ///< by patch; the last one each held
};

}  // namespace atlaswire::render
