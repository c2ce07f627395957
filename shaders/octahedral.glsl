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

vec3 unpack_normal(uint word) { return octahedral_direction(unpackSnorm2x16(word)); }

// Direction, and handedness in w.
vec4 unpack_tangent(uint word) {
  vec3 direction = octahedral_direction(unpackSnorm2x16(word & 0xfffefffeu));
  return vec4(direction, (word & 1u) != 0u ? -1.0 : 1.0);
}

#endif
