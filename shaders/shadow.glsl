// The sun's share that reaches a point: four bilinear comparisons, a tent of about 3 x 3 texels.
#ifndef ATLASWIRE_SHADERS_SHADOW_GLSL
#define ATLASWIRE_SHADERS_SHADOW_GLSL

// `n_dot_l` > 0. The point is lifted along its normal, the more the more the light grazes, so that a texel's
// depth range does not shadow its own surface.
float sun_visibility(vec3 position, vec3 normal, float n_dot_l) {
  vec3 lifted = position + normal * (scene.shadow_offsets.x * (1.2 - n_dot_l));
  vec4 p = vec4(lifted, 1.0);
  vec3 at = vec3(dot(scene.shadow_row[0], p), dot(scene.shadow_row[1], p), dot(scene.shadow_row[2], p));
  at.z += scene.shadow_offsets.y;
  float reach = 0.75 / scene.to_sun.w;
  float lit = texture(shadow_map, at + vec3(-reach, -reach, 0.0));
  lit += texture(shadow_map, at + vec3(reach, -reach, 0.0));
  lit += texture(shadow_map, at + vec3(-reach, reach, 0.0));
  lit += texture(shadow_map, at + vec3(reach, reach, 0.0));
  return lit * 0.25;
}

#endif
