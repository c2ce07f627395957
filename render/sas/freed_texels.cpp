#include "render/sas/freed_texels.h"

#include <algorithm>

namespace atlaswire::render {

FreedTexels::FreedTexels(Extent2D atlas, std::uint32_t min_block_log2, std::uint32_t patch_count)
    : cell_log2_(min_block_log2),
      cells_{atlas.width >> min_block_log2, atlas.height >> min_block_log2},
      states_(cells_.area(), Cell::kClean),
      blocks_(patch_count) {}

void FreedTexels::fill(const Block& block, Cell state) {
  const std::uint32_t width = block.width() >> cell_log2_;
  const std::uint32_t height = block.height() >> cell_log2_;
  for (std::uint32_t row = 0; row < height; ++row) {
    const std::size_t y = (block.y >> cell_log2_) + row;
    const auto first =
        states_.begin() + static_cast<std::ptrdiff_t>(y * cells_.width + (block.x >> cell_log2_));
    std::fill_n(first, width, state);
  }
}

void FreedTexels::apply(const LayoutChange& change) {
  for (const PatchId patch : change.removed) fill(blocks_[value(patch)], Cell::kFreed);
  for (const PlacedPatch& moved : change.moved) fill(blocks_[value(moved.patch)], Cell::kFreed);
  for (const auto* list : {&change.added, &change.moved}) {
    for (const PlacedPatch& placed : *list) {
      fill(placed.block, Cell::kHeld);
      blocks_[value(placed.patch)] = placed.block;
    }
  }
}

std::vector<TexelRect> FreedTexels::take() {
  std::vector<TexelRect> rects;
  std::vector<std::size_t> above;  // rectangles that reach the row before, by x
  std::vector<std::size_t> here;
  for (std::uint32_t y = 0; y < cells_.height; ++y) {
    const auto row = states_.begin() + static_cast<std::ptrdiff_t>(std::size_t{y} * cells_.width);
    const auto end = row + cells_.width;
    auto candidate = above.begin();
    here.clear();
    for (auto at = std::find(row, end, Cell::kFreed); at != end; at = std::find(at, end, Cell::kFreed)) {
      const auto stop = std::find_if(at, end, [](Cell c) { return c != Cell::kFreed; });
      std::fill(at, stop, Cell::kClean);
      const auto x = static_cast<std::uint32_t>(at - row);
      const auto width = static_cast<std::uint32_t>(stop - at);
      while (candidate != above.end() && rects[*candidate].x < x) ++candidate;
      if (candidate != above.end() && rects[*candidate].x == x && rects[*candidate].width == width) {
        ++rects[*candidate].height;
        here.push_back(*candidate);
      } else {
        here.push_back(rects.size());
        rects.push_back({.x = x, .y = y, .width = width, .height = 1});
      }
      at = stop;
    }
    above.swap(here);
  }
  for (TexelRect& r : rects) {
    r = {r.x << cell_log2_, r.y << cell_log2_, r.width << cell_log2_, r.height << cell_log2_};
  }
  return rects;
}

}  // namespace atlaswire::render
