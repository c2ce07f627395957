// Punctual lights (KHR_lights_punctual): inverse square falloff, windowed at the light's range.
#ifndef ATLASWIRE_SHADERS_LIGHTS_GLSL
#define ATLASWIRE_SHADERS_LIGHTS_GLSL

#include "shaders/brdf.glsl"
#include "shaders/octahedral.glsl"

// Without branches: on a CPU they save nothing but a loop's last turn.
vec3 light_contribution(LightConstants light, Reflectance surface, vec3 position, vec3 normal, vec3 plane, vec3 to_viewer) {
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
  // A bent normal must not catch light from behind its surface.
  if (has(kFeatureNormalMap)) strength *= clamp(dot(plane, to_light) * 16.0, 0.0, 1.0);
  vec3 color = vec3(unpackHalf2x16(light.color_rg), blue_and_range.x);
  return color * (strength * reflect_light(surface, to_viewer, to_light, max(dot(normal, to_light), 0.0)));
}

// Those of the list that begins at `list` (render/passes/light_table.h); no list is empty. `plane`: the normal before bending.
vec3 punctual_lights(uint list, Reflectance surface, vec3 position, vec3 normal, vec3 plane, vec3 to_viewer) {
  vec3 sum = vec3(0.0);
  uint past = list + light_lists[list];
  // Tested after the body: rasterizers on a CPU run a body once more than a leading test lets through.
  do {
    list += 1u;
    sum += light_contribution(lights[light_lists[list]], surface, position, normal, plane, to_viewer);
  } while (list < past);
  return sum;
}

#endif
