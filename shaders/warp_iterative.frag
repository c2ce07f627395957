#version 460
#extension GL_GOOGLE_include_directive : require
// Iterative image warp (Yang et al. 2011, with Bowles et al. 2012's view of it as a fixed point). The source pixel
// of an output pixel is where the rotation alone puts it plus parallax in proportion to the inverse distance w that
// the source has there: p = p0 + w e, w = W(p). The search iterates w <- W(p0 + w e).
//
// * W is interpolated bilinearly, which is exact on planes; across an edge it is the sheet that a mesh has.
// * Starts: w = 0, the rotation-only guess, then equal steps up to the largest w in the source. Where several
//   starts end at different pixels that all land here, the nearest surface hides the others.
// * A search has converged when its last step moved less than half a source pixel. Where none has (at
//   disocclusions), the one with the smallest last step is shown.
// * Pixels that end outside the source, or behind the display, count for nothing; with nothing left there is no
//   colour.
#include "shaders/warp.glsl"

layout(constant_id = 0) const uint kIterations = 8u;
layout(constant_id = 1) const uint kStarts = 4u;

layout(location = 0) out vec4 color;

const float kTolerance = 0.5;  // source pixels

float inverse_distance_at(vec2 pixel) {
  ivec2 last = ivec2(draw.source_extent) - 1;
  vec2 at = clamp(pixel - 0.5, vec2(0.0), vec2(last));
  ivec2 low = ivec2(at);
  ivec2 high = min(low + 1, last);
  int row = last.x + 1;
  vec2 share = at - vec2(low);
  float above = mix(inverse_distance[low.y * row + low.x], inverse_distance[low.y * row + high.x], share.x);
  float below = mix(inverse_distance[high.y * row + low.x], inverse_distance[high.y * row + high.x], share.x);
  return mix(above, below, share.y);
}

void main() {
  vec3 far = at_infinity(gl_FragCoord.xy);
  if (far.z <= 0.0) discard;
  vec2 start = far.xy / far.z;
  vec2 epipolar = draw.parallax.xy - draw.parallax.z * start;

  vec2 best = vec2(-1.0);
  float best_step = 1e30;
  float best_nearness = -1.0;
  for (uint i = 0u; i < kStarts; ++i) {
    float w = draw.parallax.w * float(i) / float(kStarts - 1u);
    vec2 pixel = start + w * epipolar;
    float last_step = 0.0;
    for (uint k = 0u; k < kIterations; ++k) {
      w = inverse_distance_at(pixel);
      vec2 next = start + w * epipolar;
      last_step = distance(next, pixel);
      pixel = next;
    }
    // What the display sees of a distance: its own inverse distance is w / scale.
    float scale = (1.0 - w * draw.parallax.z) / far.z;
    if (scale <= 0.0 || !in_source(pixel)) continue;
    float nearness = w / scale;
    bool converged = last_step < kTolerance;
    bool better = converged && best_step < kTolerance ? nearness > best_nearness : last_step < best_step;
    if (better) {
      best = pixel;
      best_step = last_step;
      best_nearness = nearness;
    }
  }
  if (best_step >= 1e30) discard;
  color = source_color(best);
}
