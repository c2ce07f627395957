// A surface point's displayed colour and coverage: the one material of the atlas and of the forward ground
// truth. What the pipeline's features leave out costs nothing.
#ifndef ATLASWIRE_SHADERS_MATERIAL_GLSL
#define ATLASWIRE_SHADERS_MATERIAL_GLSL

#include "shaders/scene_layout.h"

layout(constant_id = 0) const uint kFeatures = 0u;

layout(push_constant) uniform Draw { DrawConstants draw; };

layout(set = 0, binding = 0) uniform Constants { SceneConstants scene; };
layout(set = 0, binding = 1) uniform Lights { LightConstants lights[kMaxLights]; };
layout(set = 0, binding = 2, std430) readonly buffer LightLists { uint light_lists[]; };
layout(set = 0, binding = 3) uniform sampler2DShadow shadow_map;

layout(set = 1, binding = 0) uniform MaterialBlock { MaterialConstants material; };
layout(set = 1, binding = 1) uniform sampler2D base_color_texture;
layout(set = 1, binding = 2) uniform sampler2D metallic_roughness_texture;
layout(set = 1, binding = 3) uniform sampler2D normal_texture;
layout(set = 1, binding = 4) uniform sampler2D emissive_texture;

bool has(uint feature) { return (kFeatures & feature) != 0u; }

#include "shaders/ambient.glsl"
#include "shaders/brdf.glsl"
#include "shaders/lights.glsl"
#include "shaders/shadow.glsl"
#include "shaders/tonemap.glsl"

// What is interpolated over a triangle.
struct SurfacePoint {
  vec3 position;  // relative to the scene's origin
  vec3 normal;
  vec4 tangent;  // w: handedness
  vec2 uv;
  uint light_list;
};

// Towards the camera's side for double-sided materials. The triangle's own plane decides, oriented as the
// vertex normals are: unlike the winding it is known in the atlas too.
vec3 facing_normal(SurfacePoint point, vec3 normal, vec3 to_viewer) {
  if (!has(kFeatureDoubleSided)) return normal;
  vec3 plane = cross(dFdx(point.position), dFdy(point.position));
  return dot(plane, normal) * dot(plane, to_viewer) < 0.0 ? -normal : normal;
}

vec3 mapped_normal(SurfacePoint point, vec3 normal, float scale) {
  vec3 tangent = point.tangent.xyz - normal * dot(normal, point.tangent.xyz);
  tangent *= inversesqrt(max(dot(tangent, tangent), 1e-12));
  vec3 bitangent = cross(normal, tangent) * point.tangent.w;
  vec3 t = texture(normal_texture, point.uv).xyz * 2.0 - 1.0;
  vec3 bent = tangent * (t.x * scale) + bitangent * (t.y * scale) + normal * max(t.z, 0.05);
  return bent * inversesqrt(dot(bent, bent));
}

// Alpha to what the atlas stores: 0.5 at a masked material's cutoff, so that its outline survives filtering.
float stored_coverage(float alpha, float cutoff) {
  return alpha < cutoff ? 0.5 * alpha / max(cutoff, 1e-4)
                        : 0.5 + 0.5 * (alpha - cutoff) / max(1.0 - cutoff, 1e-4);
}

vec4 evaluate_material(SurfacePoint point) {
  vec4 base = material.base_color;
  if (has(kFeatureBaseTexture)) base *= texture(base_color_texture, point.uv);
  float coverage = 1.0;
  if (has(kFeatureAlphaMask) && !has(kFeatureDiscard)) coverage = stored_coverage(base.a, material.factors.w);
  if (has(kFeatureAlphaBlend)) coverage = base.a;

  float metallic = material.factors.x;
  float roughness = material.factors.y;
  if (has(kFeatureMetallicRoughnessTexture)) {
    vec2 sampled = texture(metallic_roughness_texture, point.uv).bg;
    metallic *= sampled.x;
    roughness *= sampled.y;
  }

  vec3 towards = (draw.camera_high.xyz - point.position) + draw.camera_low.xyz;
  vec3 to_viewer = towards * inversesqrt(max(dot(towards, towards), 1e-12));
  vec3 vertex_normal = point.normal * inversesqrt(max(dot(point.normal, point.normal), 1e-12));
  vec3 geometric = facing_normal(point, vertex_normal, to_viewer);
  vec3 normal = geometric;
  if (has(kFeatureNormalMap)) normal = mapped_normal(point, geometric, material.factors.z);

  float n_dot_v = clamp(dot(normal, to_viewer), 1e-3, 1.0);
  Reflectance surface = make_reflectance(base.rgb, metallic, roughness, n_dot_v);
  vec3 radiance = ambient_light(surface.diffuse * kPi, surface.specular, roughness, normal, to_viewer, n_dot_v);
  if (has(kFeatureSun)) {
    float n_dot_l = dot(normal, scene.to_sun.xyz);
    float plane_n_dot_l = dot(geometric, scene.to_sun.xyz);
    if (n_dot_l > 0.0 && plane_n_dot_l > 0.0) {
      float lit = sun_visibility(point.position, geometric, plane_n_dot_l);
      radiance += scene.sun_color.rgb * lit * reflect_light(surface, to_viewer, scene.to_sun.xyz, n_dot_l);
    }
  }
  if (has(kFeatureLights)) radiance += punctual_lights(point.light_list, surface, point.position, normal, geometric, to_viewer);
  if (has(kFeatureEmissive)) {
    vec3 emitted = material.emissive.rgb;
    if (has(kFeatureEmissiveTexture)) emitted *= texture(emissive_texture, point.uv).rgb;
    radiance += emitted;
  }
  // Last, so that every derivative above is defined.
  if (has(kFeatureDiscard) && base.a < material.factors.w) discard;
  return vec4(display_color(radiance, scene.sun_color.w), coverage);
}

#endif
