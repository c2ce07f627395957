#include "render/atlas/usage_overlay.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace atlaswire::render {

namespace {

constexpr Rgba8 kFree{24, 24, 28, 255};
constexpr Rgba8 kOutline{64, 64, 72, 255};

/// `position` 0..1 along colours, mixed between neighbours.
template <std::size_t Count>
Rgba8 along(const std::array<Rgba8, Count>& colours, double position) {
  const double at = std::clamp(position, 0.0, 1.0) * (Count - 1);
  const auto first = std::min(static_cast<std::size_t>(at), Count - 2);
  const double share = at - static_cast<double>(first);
  Rgba8 mixed{0, 0, 0, 255};
  for (std::size_t c = 0; c < 3; ++c) {
    mixed[c] = static_cast<std::uint8_t>(
        std::lround(colours[first][c] * (1 - share) + colours[first + 1][c] * share));
  }
  return mixed;
}

void draw_block(Picture& picture, const Block& block, Rgba8 inside) {
  const Rgba8 edge{std::uint8_t(inside[0] / 2), std::uint8_t(inside[1] / 2), std::uint8_t(inside[2] / 2),
                   255};
  for (std::uint32_t y = 0; y < block.height(); ++y) {
    for (std::uint32_t x = 0; x < block.width(); ++x) {
      const bool last = x + 1 == block.width() || y + 1 == block.height();
      picture.set(block.x + x, block.y + y, last ? edge : inside);
    }
  }
}

}  // namespace

void UsageOverlay::observe(const LayoutChange& change) {
  ++frame_;
  for (const PatchId patch : change.removed) placed_.erase(patch);
  for (const auto* list : {&change.added, &change.moved}) {
    for (const PlacedPatch& p : *list) placed_[p.patch] = {p.block, frame_};
  }
}

Picture UsageOverlay::picture(LayoutColours colours) const {
  switch (colours) {
    case LayoutColours::kLevel:
      return by_level();
    case LayoutColours::kAge:
      return by_age();
    case LayoutColours::kClass:
      break;
  }
  return by_class();
}

Picture UsageOverlay::by_level() const {
  static constexpr std::array<Rgba8, 4> kHues{
      {{220, 60, 50, 255}, {230, 200, 60, 255}, {70, 180, 90, 255}, {60, 110, 220, 255}}};
  Picture picture = empty_atlas();
  for (const auto& [patch, placed] : placed_) {
    const double area_log2 = placed.block.width_log2 + placed.block.height_log2;
    draw_block(picture, placed.block, along(kHues, area_log2 / (2.0 * std::max(1U, superblock_log2_))));
  }
  return picture;
}

Picture UsageOverlay::by_age(std::uint32_t old_frames) const {
  static constexpr std::array<Rgba8, 3> kHeat{{{255, 255, 255, 255}, {220, 60, 40, 255}, {40, 60, 140, 255}}};
  Picture picture = empty_atlas();
  for (const auto& [patch, placed] : placed_) {
    const auto age = static_cast<double>(frame_ - placed.since);
    draw_block(picture, placed.block, along(kHeat, age / std::max(1U, old_frames)));
  }
  return picture;
}

Picture UsageOverlay::by_class() const {
  static constexpr Rgba8 kAllocated{70, 180, 90, 255};
  static constexpr Rgba8 kFragmented{235, 150, 50, 255};
  static constexpr Rgba8 kWholeFree{110, 80, 150, 255};
  const std::uint32_t columns = atlas_.width >> superblock_log2_;
  std::vector<bool> in_use(std::size_t{columns} * (atlas_.height >> superblock_log2_));
  const auto superblock_at = [&](std::uint32_t x, std::uint32_t y) {
    return std::size_t{y >> superblock_log2_} * columns + (x >> superblock_log2_);
  };
  for (const auto& [patch, placed] : placed_) in_use[superblock_at(placed.block.x, placed.block.y)] = true;
  Picture picture = empty_atlas();
  for (std::uint32_t y = 0; y < atlas_.height; ++y) {
    for (std::uint32_t x = 0; x < atlas_.width; ++x) {
      if (picture.at(x, y) == kOutline) continue;
      picture.set(x, y, in_use[superblock_at(x, y)] ? kFragmented : kWholeFree);
    }
  }
  for (const auto& [patch, placed] : placed_) draw_block(picture, placed.block, kAllocated);
  return picture;
}

double UsageOverlay::mean_age() const {
  double texels = 0;
  double sum = 0;
  for (const auto& [patch, placed] : placed_) {
    texels += placed.block.area();
    sum += placed.block.area() * static_cast<double>(frame_ - placed.since);
  }
  return texels > 0 ? sum / texels : 0;
}

Picture UsageOverlay::empty_atlas() const {
  Picture picture(atlas_, kFree);
  const std::uint32_t mask = (1U << superblock_log2_) - 1;
  for (std::uint32_t y = 0; y < atlas_.height; ++y) {
    for (std::uint32_t x = 0; x < atlas_.width; ++x) {
      if ((x & mask) == mask || (y & mask) == mask) picture.set(x, y, kOutline);
    }
  }
  return picture;
}

}  // namespace atlaswire::render
