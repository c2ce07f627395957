#version 460
#extension GL_GOOGLE_include_directive : require
// Iterative image warp (Yang et al. 2011, with Bowles et al. 2012's view of it as a fixed point). The source pixel
// of an output pixel is where the rotation alone puts it plus parallax in proportion to the inverse distance w that
// the source has there: p = p0 + w e, w = W(p). The search iterates w <- W(p0 + w e).
//
// * W is interpolated bilinearly, which is exact on planes; across an edge it is the sheet that a mesh has.
// * Starts: w = 0, the rotation-only guess, then equal steps up to the largest w in the source. Where several
//   starts end at different pixels that all land here, the nearest surface hides the others.
// * The second half of the steps goes half as far, so that a search that jumps to and fro across an edge settles.
// * Of each search its best step counts, the shortest. A search has converged when that is below half a source
//   pixel; where none has (at disocclusions), the one with the shortest is shown.
// * Pixels that end outside the source, or behind the display, count for nothing; with nothing left there is no
//   colour.
#include "shaders/warp.glsl"

layout(constant_id = 0) const uint kIterations = 8u;
layout(constant_id = 1) const uint kStarts = 3u;

layout(location = 0) out vec4 color;

const float kTolerance = 0.5;  // source pixels
const float kNone = 1e30;      // longer than any step

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

// Where a search ended: the source pixel, its inverse distance, and how long the last step was.
struct Found {
  vec2 pixel;
  float w;
  float residual;
};

Found search(vec2 start, vec2 epipolar, float w) {
  vec2 pixel = start + w * epipolar;
  Found found = Found(pixel, w, kNone);
  for (uint k = 0u; k < kIterations; ++k) {
    w = inverse_distance_at(pixel);
    vec2 next = start + w * epipolar;
    float residual = distance(next, pixel);
    if (residual < found.residual) found = Found(next, w, residual);
    pixel = k < kIterations / 2u ? next : mix(pixel, next, 0.5);
  }
  return found;
}

void main() {
  vec3 far = at_infinity(gl_FragCoord.xy);
  if (far.z <= 0.0) discard;
  vec2 start = far.xy / far.z;
  vec2 epipolar = draw.parallax.xy - draw.parallax.z * start;

  Found best = Found(vec2(0.0), 0.0, kNone);
  float best_nearness = 0.0;  // inverse distance from the display
  for (uint i = 0u; i < kStarts; ++i) {
    Found found = search(start, epipolar, draw.parallax.w * float(i) / float(kStarts - 1u));
    float scale = (1.0 - found.w * draw.parallax.z) / far.z;  // distance from the display over that in the source
    if (scale <= 0.0 || !in_source(found.pixel)) continue;
    float nearness = found.w / scale;
    bool both_converged = max(found.residual, best.residual) < kTolerance;
    if (both_converged ? nearness > best_nearness : found.residual < best.residual) {
      best = found;
      best_nearness = nearness;
    }
  }
  if (best.residual == kNone) discard;
  color = source_color(best.pixel);
}
