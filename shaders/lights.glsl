// Punctual lights of a chunk (KHR_lights_punctual): inverse square falloff, windowed at the light's range.
#ifndef ATLASWIRE_SHADERS_LIGHTS_GLSL
#define ATLASWIRE_SHADERS_LIGHTS_GLSL

#include "shaders/brdf.glsl"
#include "shaders/octahedral.glsl"

// Without branches: on a CPU they save nothing but a loop's last turn.
vec3 light_contribution(LightConstants light, Reflectance surface, vec3 position, vec3 normal, vec3 to_viewer) {
  vec2 blue_and_range = unpackHalf2x16(light.color_b_inverse_range);
  vec3 towards = light.position - position;
  float distance2 = max(dot(towards, towards), 1e-4);
  float inverse = inversesqrt(distance2);
  vec3 to_light = towards * inverse;
  float reach = min(distance2 * blue_and_range.y * blue_and_range.y, 1.0);
  float strength = (1.0 - reach * reach) * inverse * inverse;
  if (has(kFeatureSpots)) {
    vec2 cone = unpackHalf2x16(light.cone_scale_offset);
    float inside = clamp(dot(to_light, unpack_normal(light.axis)) * cone.x + cone.y, 0.0, 1.0);
    strength *= inside * inside;
  }
  vec3 color = vec3(unpackHalf2x16(light.color_rg), blue_and_range.x);
  return color * (strength * reflect_light(surface, to_viewer, to_light, max(dot(normal, to_light), 0.0)));
}

vec3 punctual_lights(Reflectance surface, vec3 position, vec3 normal, vec3 to_viewer) {
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < draw.light_count; ++i) {
    sum += light_contribution(lights[light_list[draw.first_light + i]], surface, position, normal, to_viewer);
  }
  return sum;
}

#endif
