#pragma once

#include "render/atlas/allocator.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace atlaswire::render {

/// A patch's projected size as the visibility pass leaves it, in 256ths of an octave: low 16 bits
/// log2(area in pixels^2) + 64, high 16 bits, signed, log2(width / height). 0 means invisible.
std::uint32_t pack_projection(double area_pixels, double aspect);

/// The bias of [SAS] eq. 3 in octaves of area: how far all areas must shrink so that they fit.
///
/// Of the ideal area `ideal` (each block clamped to the legal sizes) the part `fixed` is at the smallest
/// size and stays. The rest shrinks by 2^-b and must fill what is left of `atlas`: (I - d) 2^-b = S - d,
/// so b = log2((I - d) / (S - d)). Negative: there is room to grow. One step only, because blocks that
/// reach the smallest size change d; and it knows nothing of rounding: LevelSelector searches on from it.
/// Where the formula ends: nothing can shrink (I <= d) gives -infinity, no bound from memory; nothing
/// fits (S <= d) gives +infinity, everything at the smallest size; both gives +infinity.
double memory_bias(double ideal, double fixed, double atlas);

/// Block sizes of one aspect and area ([SAS] 4.3, eq. 2): area is rounded to 2^A, clamped to legal blocks;
/// the aspect to the nearest 2^a with a of A's parity, and from there to legal sides at the same area.
/// Portrait becomes landscape by transposing. Both in 256ths of an octave, area already biased.
BlockRequest round_level(PatchId patch, std::int32_t area, std::int32_t aspect, const AllocatorSettings& s);

/// Settings of level selection; each trades memory or stillness against sharpness.
struct LevelSettings {
  AllocatorSettings allocator;
  double target_fill = 0.8;       ///< 0..1: share of the atlas that blocks may take
  double max_oversampling = 4.0;  ///< >= 1: texels a pixel may get when the atlas has room
  double hysteresis = 0.25;       ///< 0..1 octaves past the rounding boundary before a level changes
};

/// Level settings as integers: what selection works with, on the host and on the device.
struct LevelRange {
  std::int32_t smallest;  ///< log2 of the smallest and largest block's area
  std::int32_t largest;
  std::int32_t lowest_bin;  ///< of the histogram: below it all areas act alike
  std::int32_t highest_bin;
  std::int32_t lowest_step;   ///< bias in eighths when the atlas has room
  std::int32_t highest_step;  ///< here every block is smallest
  std::int32_t margin;        ///< hysteresis in 256ths
  std::uint64_t target;       ///< texels
};

/// Throws ProgramError for settings out of range.
LevelRange level_range(const LevelSettings& settings);

/// What one selection did.
struct LevelStats {
  double bias = 0;            ///< octaves of area, in eighths; below 0 the atlas has room to spare
  double one_step_bias = 0;   ///< [SAS] eq. 3 before the search; may be infinite
  std::uint64_t texels = 0;   ///< area of all requests; over target only if smallest blocks do not fit
  std::uint32_t visible = 0;  ///< requests
  std::uint32_t demoted = 0;  ///< lost their hysteresis to memory
};

/// Chooses each visible patch's block size under one bias that makes them fit ([SAS] 4.3).
/// Deterministic; keeps each patch's level, also while it is hidden, so that sizes do not flicker.
class LevelSelector {
 public:
  /// Throws ProgramError for settings out of range.
  LevelSelector(const LevelSettings& settings, std::uint32_t patch_count);

  /// `packed` holds one projection for each patch; `out` becomes the visible ones' requests, ascending.
  /// The bias rises at once when memory is short; it falls slowly, once a quarter octave too high.
  const LevelStats& select(std::span<const std::uint32_t> packed, std::vector<BlockRequest>& out);

 private:
  struct Visible {
    std::uint32_t patch;
    std::uint32_t packed;
  };

  [[nodiscard]] std::span<const Visible> visible() const { return std::span(gathered_).first(found_); }
  void scan(std::span<const std::uint32_t> packed);
  [[nodiscard]] std::uint64_t predicted(std::int32_t bias_step) const;
  void choose_bias();
  void assign(std::vector<BlockRequest>& out);
  void demote(std::vector<BlockRequest>& out);
  [[nodiscard]] bool keeps(const BlockRequest& previous, std::int32_t area, std::int32_t aspect) const;

  LevelSettings settings_;
  LevelRange range_;
  std::vector<std::uint32_t> histogram_;  ///< visible patches by area, in eighths of an octave
  std::vector<Visible> gathered_;         ///< room for every patch
  std::size_t found_ = 0;                 ///< how many of them count
  std::vector<std::uint16_t> levels_;     ///< by patch: width, height, transposed; 0 = none yet
  bool has_bias_ = false;
  std::int32_t step_ = 0;  ///< bias in eighths
  LevelStats stats_;
};

}  // namespace atlaswire::render
