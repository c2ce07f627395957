// What SceneGpu uploads and the shading and forward passes read. Included by GLSL and by C++.
#ifndef ATLASWIRE_SHADERS_SCENE_LAYOUT_H
#define ATLASWIRE_SHADERS_SCENE_LAYOUT_H

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
namespace atlaswire::render::gpu_layout {
using mat4 = glm::mat4;
using vec4 = glm::vec4;
using vec3 = glm::vec3;
using vec2 = glm::vec2;
using uint = std::uint32_t;
#define AW_CONST inline constexpr std::uint32_t
#else
#define AW_CONST const uint
#endif

/// Bits of specialization constant 0: what a material's pipeline does. A bit that is off costs nothing.
AW_CONST kFeatureBaseTexture = 1u;
AW_CONST kFeatureMetallicRoughnessTexture = 2u;
AW_CONST kFeatureNormalMap = 4u;
AW_CONST kFeatureEmissive = 8u;
AW_CONST kFeatureEmissiveTexture = 16u;
AW_CONST kFeatureAlphaMask = 32u;
AW_CONST kFeatureAlphaBlend = 64u;
AW_CONST kFeatureDoubleSided = 128u;
AW_CONST kFeatureSun = 256u;
AW_CONST kFeatureLights = 512u;
AW_CONST kFeatureSpots = 1024u;
AW_CONST kFeatureDiscard = 2048u;  // alpha below the cutoff is a hole here; else it becomes coverage

/// Punctual lights that fit in a uniform buffer of 32 KiB.
AW_CONST kMaxLights = 1024u;

/// Push constants of every pass that draws scene geometry.
struct DrawConstants {
  mat4 clip_from_relative;  // projection times rotation; the shading pass ignores it
  vec4 camera_high;         // camera relative to the scene's origin, rounded to float
  vec4 camera_low;          // what that rounding lost
  vec2 clip_from_texel;     // 2 / atlas extent, of the shading pass
  uint light_list;          // where the chunk's begins, of the forward pass
  uint unused;
};

/// What all of a scene's surfaces share.
struct SceneConstants {
  vec4 ambient_up;      // rgb
  vec4 ambient_down;    // rgb
  vec4 sun_color;       // rgb; w: exposure
  vec4 to_sun;          // xyz unit; w: shadow map texels per unit of texture coordinate
  vec4 shadow_row[3];   // affine: scene position to shadow map (u, v, depth)
  vec4 shadow_offsets;  // x: metres along the normal at grazing light; y: depth subtracted always
};

/// One material.
struct MaterialConstants {
  vec4 base_color;
  vec4 emissive;  // rgb
  vec4 factors;   // metallic, roughness, normal scale, alpha cutoff
};

/// One point or spot light, packed: fetching it is a good part of what it costs. Halves come in pairs, the
/// first in the low 16 bits.
struct LightConstants {
  vec3 position;
  uint color_rg;               // halves
  uint color_b_inverse_range;  // halves
  uint axis;                   // against the direction of travel: two snorm16, octahedral
  uint cone_scale_offset;      // halves: clamp(dot(to light, axis) * scale + offset, 0, 1) squared
  uint unused;
};

#undef AW_CONST
#ifdef __cplusplus
static_assert(sizeof(DrawConstants) == 112 && offsetof(DrawConstants, clip_from_texel) == 96);
static_assert(sizeof(SceneConstants) == 128 && offsetof(SceneConstants, shadow_row) == 64);
static_assert(sizeof(MaterialConstants) == 48);
static_assert(sizeof(LightConstants) == 32);
}  // namespace atlaswire::render::gpu_layout
#endif

#endif  // ATLASWIRE_SHADERS_SCENE_LAYOUT_H
