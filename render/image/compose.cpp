#include "render/image/compose.h"

#include "base/assert.h"
#include "render/image/font.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace atlaswire::render {

namespace {

constexpr std::uint32_t kGlyphWidth = 5;
constexpr std::uint32_t kGlyphHeight = 7;
constexpr std::uint32_t kAdvance = kGlyphWidth + 1;

void fill_square(Picture& image, std::uint32_t x, std::uint32_t y, std::uint32_t side, Rgba8 ink) {
  for (std::uint32_t v = y; v < std::min(y + side, image.extent.height); ++v) {
    for (std::uint32_t u = x; u < std::min(x + side, image.extent.width); ++u) image.set(u, v, ink);
  }
}

/// `over` on an opaque background by its alpha; sRGB values are mixed as they are, good enough to look at.
void paste(Picture& onto, const Picture& over, std::uint32_t left, std::uint32_t top) {
  for (std::uint32_t y = 0; y < over.extent.height; ++y) {
    for (std::uint32_t x = 0; x < over.extent.width; ++x) {
      const Rgba8 from = over.at(x, y);
      Rgba8 mixed = onto.at(left + x, top + y);
      for (std::size_t c = 0; c < 3; ++c) {
        mixed[c] = static_cast<std::uint8_t>((from[c] * from[3] + mixed[c] * (255 - from[3]) + 127) / 255);
      }
      onto.set(left + x, top + y, mixed);
    }
  }
}

}  // namespace

Picture side_by_side(std::span<const Panel> panels, const RowStyle& style) {
  AW_ASSERT(style.label_scale >= 1 && style.label_scale <= 16);
  Extent2D extent{style.gap, 0};
  bool labels = false;
  for (const Panel& panel : panels) {
    AW_ASSERT(panel.image != nullptr);
    extent.width += panel.image->extent.width + style.gap;
    extent.height = std::max(extent.height, panel.image->extent.height);
    labels = labels || !panel.label.empty();
  }
  const std::uint32_t top = style.gap + (labels ? kGlyphHeight * style.label_scale + style.gap : 0);
  extent.height += top + style.gap;
  Picture row(extent, {style.background[0], style.background[1], style.background[2], 255});
  std::uint32_t left = style.gap;
  for (const Panel& panel : panels) {
    const std::size_t room = panel.image->extent.width / (kAdvance * style.label_scale);
    draw_text(row, left, style.gap, std::string_view(panel.label).substr(0, room), style.label_scale,
              style.ink);
    paste(row, *panel.image, left, top);
    left += panel.image->extent.width + style.gap;
  }
  return row;
}

Picture resized_nearest(const Picture& image, Extent2D extent) {
  if (image.empty() || extent.area() == 0) return Picture(extent);
  Picture out(extent);
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    const auto from_y = static_cast<std::uint32_t>(std::uint64_t{y} * image.extent.height / extent.height);
    for (std::uint32_t x = 0; x < extent.width; ++x) {
      const auto from_x = static_cast<std::uint32_t>(std::uint64_t{x} * image.extent.width / extent.width);
      out.set(x, y, image.at(from_x, from_y));
    }
  }
  return out;
}

void draw_text(Picture& image, std::uint32_t x, std::uint32_t y, std::string_view text, std::uint32_t scale,
               Rgba8 ink) {
  for (const char c : text) {
    const Glyph& glyph = glyph_of(c);
    for (std::uint32_t row = 0; row < kGlyphHeight; ++row) {
      for (std::uint32_t column = 0; column < kGlyphWidth; ++column) {
        const bool set = ((glyph.rows[row] >> (kGlyphWidth - 1 - column)) & 1) != 0;
        if (set) fill_square(image, x + column * scale, y + row * scale, scale, ink);
      }
    }
    x += kAdvance * scale;
  }
}

Picture heat_difference(const Picture& reference, const Picture& picture, double gain) {
  AW_ASSERT(reference.extent == picture.extent);
  const auto channel = [](double v) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0, 1.0)));
  };
  Picture heat(reference.extent);
  for (std::uint32_t y = 0; y < heat.extent.height; ++y) {
    for (std::uint32_t x = 0; x < heat.extent.width; ++x) {
      const Rgba8 a = reference.at(x, y);
      const Rgba8 b = picture.at(x, y);
      int largest = 0;
      for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(int{a[c]} - int{b[c]}));
      const double heat_level = std::min(1.0, gain * largest / 255) * 3;
      heat.set(x, y, {channel(heat_level), channel(heat_level - 1), channel(heat_level - 2), 255});
    }
  }
  return heat;
}

}  // namespace atlaswire::render
