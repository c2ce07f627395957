#pragma once

#include "render/atlas/allocator.h"
#include "render/atlas/block_level.h"
#include "render/atlas/superblock_store.h"

#include <cstdint>

namespace atlaswire::render {

/// How a frame ended, in numbers.
struct AtlasOutcome {
  bool reset = false;
  std::uint32_t visible = 0;   ///< patches
  std::uint32_t refused = 0;   ///< of these, without a block
  std::uint32_t shrunken = 0;  ///< of these, with a smaller block than wanted
  std::uint32_t used_superblocks = 0;
};

/// Texels below the high-water mark.
std::uint64_t high_water_texels(const AllocatorSettings& settings);

/// What patches want against what the atlas has: decides on caps and resets. Counts in smallest blocks,
/// and sums saturate at 2^31 - 1, so that a device without 64-bit integers decides alike.
class AtlasDemand {
 public:
  explicit AtlasDemand(const AllocatorSettings& settings);

  /// log2 of the largest area, in texels, that all requests can be capped at and fit into `room` texels; the
  /// smallest block's if even that does not fit.
  [[nodiscard]] std::uint32_t area_cap(const PerLevel& requested, std::uint64_t room) const;

  /// Whether a reset is asked for and would change anything. Asked for: the share outside free superblocks
  /// is above the high-water mark and packing anew would free a thirty-second of the atlas; or a block is
  /// smaller than wanted although everything wanted fits, unless the last reset failed at about as much; or
  /// a patch is refused although the atlas has a smallest block for it. Once a frame, at its end.
  bool reset_helps(const PerLevel& wanted, const AtlasOutcome& outcome);

 private:
  LevelNumbers numbers_;
  std::uint32_t superblocks_;
  std::uint32_t high_superblocks_;     ///< at most these in use are fine
  std::uint32_t capacity_;             ///< smallest blocks
  std::uint32_t futile_ = kSaturated;  ///< a reset at no less than this would leave blocks shrunken
  static constexpr std::uint32_t kSaturated = 0x7FFFFFFF;
};

/// Throws ProgramError unless superblocks tile the atlas and blocks fit them.
void check_allocator_settings(const AllocatorSettings& settings);

}  // namespace atlaswire::render
