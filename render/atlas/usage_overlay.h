#pragma once

#include "render/atlas/allocator.h"
#include "render/image/picture.h"

#include <cstdint>
#include <map>

namespace atlaswire::render {

/// What an overlay's colours tell.
enum class LayoutColours : std::uint8_t { kClass, kLevel, kAge };

/// Draws an atlas's memory, for people and reports: which blocks lie where, and since when.
/// Texels outside blocks are dark; block edges are darker than their insides, and superblocks are outlined.
class UsageOverlay {
 public:
  UsageOverlay(Extent2D atlas, std::uint32_t superblock_log2)
      : atlas_(atlas), superblock_log2_(superblock_log2) {}

  /// Follows one frame; every frame's change must come, in order.
  void observe(const LayoutChange& change);

  [[nodiscard]] Picture picture(LayoutColours colours) const;
  /// Hue by area: red for the smallest blocks, then yellow, green and blue for the largest.
  [[nodiscard]] Picture by_level() const;
  /// White for blocks placed in the newest frame, cooling through red to blue after `old_frames` frames.
  [[nodiscard]] Picture by_age(std::uint32_t old_frames = 30) const;
  /// Green where blocks are, orange where texels of a superblock in use are free (on a stack, in a tail, or
  /// lost until a reset), purple where superblocks are free: the colours of [SAS] fig. 11.
  [[nodiscard]] Picture by_class() const;
  /// Mean frames since each texel's block was placed: temporal coherence in one number; 0 if empty.
  [[nodiscard]] double mean_age() const;

 private:
  struct Placed {
    Block block;
    std::uint64_t since;  ///< frame, counted by observe
  };
  [[nodiscard]] Picture empty_atlas() const;

  Extent2D atlas_;
  std::uint32_t superblock_log2_;
  std::uint64_t frame_ = 0;
  std::map<PatchId, Placed> placed_;
};

}  // namespace atlaswire::render
