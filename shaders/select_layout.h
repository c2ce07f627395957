// What the passes of level selection and render/atlas_gpu/device_selector share. Included by GLSL and by C++.
#ifndef ATLASWIRE_SHADERS_SELECT_LAYOUT_H
#define ATLASWIRE_SHADERS_SELECT_LAYOUT_H

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
namespace atlaswire::render::select {
using uint = std::uint32_t;
#define AW_CONST inline constexpr std::uint32_t
#else
#define AW_CONST const uint
#endif

/// Invocations of a work group.
AW_CONST kSelectGroup = 256u;
/// Most bins of the histogram of areas: 8 an octave, for block sides from 2^0 to 2^12, 16 octaves of headroom
/// above and 16 of oversampling below.
AW_CONST kMostBins = 449u;

/// Push constants of every pass. Areas are counted in smallest blocks.
struct SelectConstants {
  uint patches;
  int smallest;  // log2 of the smallest block's area in texels
  int largest;
  int lowest_bin;
  int highest_bin;
  int lowest_step;
  int highest_step;
  int margin;  // of hysteresis, 256ths of an octave
  uint target;
};

/// The selector's state, and a frame's sums.
struct Selection {
  uint demote_groups[4];  // VkDispatchIndirectCommand over patches; none unless hysteresis must yield
  int step;               // the bias, in eighths of an octave
  uint has_bias;
  uint texels;
  uint visible;
  uint demoted;
  uint excess;
  uint padding[2];
  uint histogram[449];
};

#undef AW_CONST
#ifdef __cplusplus
static_assert(sizeof(SelectConstants) == 36);
static_assert(offsetof(Selection, step) == 16 && offsetof(Selection, histogram) == 48);
static_assert(sizeof(Selection) == 48 + 4 * kMostBins);
}  // namespace atlaswire::render::select
#endif

#endif  // ATLASWIRE_SHADERS_SELECT_LAYOUT_H
