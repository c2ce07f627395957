// Unit vectors in 32 bits: mirrors pack_normal and pack_tangent of render/scene/scene.h.
#ifndef ATLASWIRE_SHADERS_OCTAHEDRAL_GLSL
#define ATLASWIRE_SHADERS_OCTAHEDRAL_GLSL

vec3 octahedral_direction(vec2 p) {
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float fold = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -fold : fold;
  n.y += n.y >= 0.0 ? -fold : fold;
  return normalize(n);
}

vec3 unpack_normal(uint packed) { return octahedral_direction(unpackSnorm2x16(packed)); }

// Direction, and handedness in w.
vec4 unpack_tangent(uint packed) {
  vec3 direction = octahedral_direction(unpackSnorm2x16(packed & 0xfffefffeu));
  return vec4(direction, (packed & 1u) != 0u ? -1.0 : 1.0);
}

#endif
