// Light from everywhere: a hemisphere between a sky and a ground colour, diffuse and glossy.
#ifndef ATLASWIRE_SHADERS_AMBIENT_GLSL
#define ATLASWIRE_SHADERS_AMBIENT_GLSL

vec3 hemisphere(float height) {
  return mix(scene.ambient_down.rgb, scene.ambient_up.rgb, clamp(height * 0.5 + 0.5, 0.0, 1.0));
}

// Pre-integrated GGX against a constant environment: Karis, "Physically based shading on mobile" (2014).
vec3 environment_reflectance(vec3 specular, float roughness, float n_dot_v) {
  vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a = min(r.x * r.x, exp2(-9.28 * n_dot_v)) * r.x + r.y;
  vec2 ab = vec2(-1.04, 1.04) * a + r.zw;
  return specular * ab.x + vec3(ab.y);
}

// `albedo`: of the diffuse part, not divided by pi.
vec3 ambient_light(vec3 albedo, vec3 specular, float roughness, vec3 normal, vec3 to_viewer, float n_dot_v) {
  float reflected_height = 2.0 * dot(normal, to_viewer) * normal.y - to_viewer.y;
  float glossy_height = mix(reflected_height, normal.y, roughness);
  return albedo * hemisphere(normal.y) +
         environment_reflectance(specular, roughness, n_dot_v) * hemisphere(glossy_height);
}

#endif
