// What the level pass writes for each patch, read by render/atlas/level_selection on the host. Included by
// GLSL and by C++.
//
// One 32-bit word a patch, in patch order. 0: not visible in this frame. Otherwise
//   bits  0..15  log2(area) * 256 + 16384, unsigned and rounded, clamped to [1, 65535]: `area` is what the
//                whole block should have in texels so that one texel's step meets one display pixel at the
//                display's centre: (U + 1) (V + 1), at most 4 U V, for a patch of U by V pixels ([SAS] eq. 1,
//                before the bias; the paper has U V, although a side of w texels makes w - 1 steps),
//                times 2^(priority - foveation)
//   bits 16..31  log2(aspect) * 256, two's complement, rounded: `aspect` is width over height of the block
//                in the patch's layout (base/patch_layout.h, u over v), (U + 1) / (V + 1); negative: taller
//                than wide, so a landscape block holds it transposed
#ifndef ATLASWIRE_SHADERS_LEVEL_LAYOUT_H
#define ATLASWIRE_SHADERS_LEVEL_LAYOUT_H

#ifdef __cplusplus
#include <cstdint>
namespace atlaswire::render {
inline constexpr double kLevelSteps = 256.0;           ///< per doubling, of area and of aspect
inline constexpr std::int32_t kLevelAreaBias = 16384;  ///< the stored value of an area of one pixel

/// log2 of the block's area in display pixels squared; only for a word that is not 0.
constexpr double level_log2_area(std::uint32_t word) {
  return (static_cast<double>(word & 0xffffU) - kLevelAreaBias) / kLevelSteps;
}
/// log2 of width over height.
constexpr double level_log2_aspect(std::uint32_t word) {
  return static_cast<double>(static_cast<std::int16_t>(word >> 16U)) / kLevelSteps;
}
}  // namespace atlaswire::render
#else
const float kLevelSteps = 256.0;
const float kLevelAreaBias = 16384.0;

uint pack_level(float log2_area, float log2_aspect) {
  uint area = uint(clamp(round(log2_area * kLevelSteps) + kLevelAreaBias, 1.0, 65535.0));
  int aspect = int(clamp(round(log2_aspect * kLevelSteps), -32768.0, 32767.0));
  return area | (uint(aspect) << 16);
}
#endif

#endif  // ATLASWIRE_SHADERS_LEVEL_LAYOUT_H
