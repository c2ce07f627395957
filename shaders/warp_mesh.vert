#version 460
#extension GL_GOOGLE_include_directive : require
// Mesh warp (Mark et al. 1997): a grid of the source's pixel centres, and a ring of vertices on its border, moved by
// depth. Each instance is the strip between two rows of vertices; no buffer holds the grid.
#include "shaders/warp.glsl"

layout(location = 0) out vec2 source_pixel;

void main() {
  uvec2 vertex = uvec2(gl_VertexIndex >> 1, gl_InstanceIndex + (gl_VertexIndex & 1));
  uvec2 extent = uvec2(draw.source_extent);
  source_pixel = clamp(vec2(vertex) - 0.5, vec2(0.0), draw.source_extent);
  uvec2 nearest = clamp(vertex, uvec2(1), extent) - 1u;
  float w = inverse_distance[nearest.y * extent.x + nearest.x];
  // Homogeneous coordinates are left as the transfer gives them, in units of the source's distance: that takes
  // in what is infinitely far, and makes interpolation linear in the source's picture.
  vec3 h = at_infinity(source_pixel) + w * draw.parallax.xyz;
  gl_Position = vec4(2.0 * h.xy / draw.target_extent - h.z, draw.near_plane * w, h.z);
}
