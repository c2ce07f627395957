#version 460
#extension GL_GOOGLE_include_directive : require
// Which chunks could still show, given what is drawn already: a chunk is dropped only if the nearest point of
// its box is behind the farthest depth everywhere that the box covers, so that no pixel changes.
#include "shaders/visibility_layout.h"

layout(local_size_x = kListGroup) in;

layout(push_constant) uniform Cull { CullConstants cull; };
layout(set = 0, binding = 1, std430) readonly buffer Farthest { float farthest[]; };
layout(set = 0, binding = 2, std430) readonly buffer Candidates { ChunkCandidate candidates[]; };
layout(set = 0, binding = 3, std430) writeonly buffer Commands { DrawCommand commands[]; };

// Rounding of the box against that of the rasterizer, relative: some hundred units in the last place.
const float kDepthSlack = 1.0 + 1e-4;
const float kPixelSlack = 1.0;
const uint kMostFineTiles = 8u;  // along a side, before coarse tiles are read instead

bool all_nearer(uint first, uint stride, uvec2 low, uvec2 high, float depth) {
  for (uint y = low.y; y <= high.y; ++y) {
    for (uint x = low.x; x <= high.x; ++x) {
      if (farthest[first + y * stride + x] <= depth) return false;
    }
  }
  return true;
}

bool may_show(vec3 low, vec3 high) {
  vec2 from = vec2(1e30);
  vec2 to = vec2(-1e30);
  float nearest = 0.0;
  for (uint i = 0u; i < 8u; ++i) {
    vec3 corner = mix(low, high, bvec3((i & 1u) != 0u, (i & 2u) != 0u, (i & 4u) != 0u));
    vec3 relative = (corner - cull.view.camera_high.xyz) - cull.view.camera_low.xyz;
    vec4 clip = cull.view.clip_from_relative * vec4(relative, 1.0);
    if (clip.w <= clip.z) return true;  // at or before the near plane
    vec2 pixel = (clip.xy / clip.w * 0.5 + 0.5) * vec2(cull.extent);
    from = min(from, pixel);
    to = max(to, pixel);
    nearest = max(nearest, clip.z / clip.w);
  }
  from = max(from - kPixelSlack, vec2(0.0));
  to = min(to + kPixelSlack, vec2(cull.extent) - 1.0);
  if (any(greaterThan(from, to))) return false;  // beside the picture
  uvec2 tiles = (cull.extent + kFineTile - 1u) / kFineTile;
  uvec2 first = uvec2(from) / kFineTile;
  uvec2 last = uvec2(to) / kFineTile;
  float depth = nearest * kDepthSlack;
  if (all(lessThan(last - first, uvec2(kMostFineTiles)))) return !all_nearer(0u, tiles.x, first, last, depth);
  uint coarse_stride = (tiles.x + kCoarseTile - 1u) / kCoarseTile;
  return !all_nearer(tiles.x * tiles.y, coarse_stride, first / kCoarseTile, last / kCoarseTile, depth);
}

void main() {
  if (gl_GlobalInvocationID.x >= cull.count) return;
  uint i = cull.first + gl_GlobalInvocationID.x;
  ChunkCandidate chunk = candidates[i];
  uint instances = may_show(chunk.low.xyz, chunk.high.xyz) ? 1u : 0u;
  commands[i] = DrawCommand(chunk.index_count, instances, chunk.first_index, 0, 0u);
}
