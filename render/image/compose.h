#pragma once

#include "render/image/picture.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace atlaswire::render {

/// One picture of a row and its caption.
struct Panel {
  const Picture* image = nullptr;  ///< not null
  std::string label;             ///< empty: none
};

/// How `side_by_side` lays panels out.
struct RowStyle {
  std::uint32_t gap = 8;          ///< pixels around and between panels
  std::uint32_t label_scale = 2;  ///< 1..16: pixels per font pixel; captions stand above their panels
  Rgba8 background{32, 32, 36, 255};
  Rgba8 ink{235, 235, 235, 255};
};

/// Pictures in a row, tops aligned, opaque (holes show the background), captions above if any has one.
Picture side_by_side(std::span<const Panel> panels, const RowStyle& style = {});

/// The picture enlarged by repeating or reduced by dropping pixels: exact texels for looking at an atlas.
Picture resized_nearest(const Picture& image, Extent2D extent);

/// Draws ASCII text in a 5 x 7 font, 6 pixels a character times `scale`, clipped at the picture's edges.
/// Letters show as capitals; what the font lacks shows as a box.
void draw_text(Picture& image, std::uint32_t x, std::uint32_t y, std::string_view text, std::uint32_t scale,
               Rgba8 ink);

/// Where two pictures of one extent differ: the largest difference of red, green and blue times `gain`,
/// as black through red and yellow to white.
Picture heat_difference(const Picture& reference, const Picture& picture, double gain = 4.0);

}  // namespace atlaswire::render
