// Radiance to display: exposure, the ACES curve as fitted by Narkowicz (2015), and sRGB's encoding. Mirrors
// render/passes/tonemap.h.
#ifndef ATLASWIRE_SHADERS_TONEMAP_GLSL
#define ATLASWIRE_SHADERS_TONEMAP_GLSL

vec3 display_color(vec3 radiance, float exposure) {
  vec3 x = max(radiance * exposure, vec3(0.0));
  vec3 mapped = clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
  return mix(1.055 * pow(mapped, vec3(1.0 / 2.4)) - 0.055, 12.92 * mapped, lessThanEqual(mapped, vec3(0.0031308)));
}

#endif
