// Punctual lights of a chunk (KHR_lights_punctual): inverse square falloff, windowed at the light's range.
#ifndef ATLASWIRE_SHADERS_LIGHTS_GLSL
#define ATLASWIRE_SHADERS_LIGHTS_GLSL

#include "shaders/brdf.glsl"

vec3 light_contribution(LightConstants light, Reflectance surface, vec3 position, vec3 normal, vec3 to_viewer) {
  vec3 towards = light.position.xyz - position;
  float distance2 = max(dot(towards, towards), 1e-4);
  vec3 to_light = towards * inversesqrt(distance2);
  float n_dot_l = dot(normal, to_light);
  float reach = distance2 * light.position.w;
  if (n_dot_l <= 0.0 || reach >= 1.0) return vec3(0.0);
  float cone = clamp(dot(to_light, light.axis.xyz) * light.color.w + light.axis.w, 0.0, 1.0);
  float falloff = (1.0 - reach * reach) * cone * cone / distance2;
  return light.color.rgb * falloff * reflect_light(surface, normal, to_viewer, to_light, n_dot_l);
}

vec3 punctual_lights(Reflectance surface, vec3 position, vec3 normal, vec3 to_viewer) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < draw.light_count; ++i) {
    sum += light_contribution(lights[light_list[draw.first_light + i]], surface, position, normal, to_viewer);
  }
  return sum;
}

#endif
