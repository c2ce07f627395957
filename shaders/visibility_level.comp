#version 460
#extension GL_GOOGLE_include_directive : require
// What each listed patch wants of the atlas ([SAS] 4.3, eq. 1) as one word, and its mark taken back.
// Edge lengths are angles times the display's pixels per radian, so a patch is measured alike wherever the
// viewer looks, behind the camera too.
#include "shaders/level_layout.h"
#include "shaders/visibility_layout.h"

layout(local_size_x = kListGroup) in;

// Square pixels of the largest patch that is held.
const float kMostHeldArea = 32.0;

layout(push_constant) uniform Level { LevelConstants level; };
layout(set = 0, binding = 1, std430) buffer Marks { uint marks[]; };
layout(set = 0, binding = 3, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 4, std430) readonly buffer Corners { PatchCorners corners[]; };
layout(set = 0, binding = 5, std430) writeonly buffer Levels { uint levels[]; };
layout(set = 0, binding = 6, std430) readonly buffer List { uint list[]; };
layout(set = 0, binding = 7, std430) readonly buffer Priorities { float priorities[]; };

vec3 scene_position(uint i) {
  return vec3(positions[3u * i], positions[3u * i + 1u], positions[3u * i + 2u]);
}

// Pixels between two points: the angle from atan2(|a x b|, a . b) with a x b = a x (b - a), so that short
// edges far away keep their digits.
float edge_pixels(vec3 a, vec3 b) {
  precise vec3 from = (a - level.camera_high.xyz) - level.camera_low.xyz;
  precise vec3 to = (b - level.camera_high.xyz) - level.camera_low.xyz;
  float sine = length(cross(from, b - a));
  float cosine = dot(from, to);
  return sine == 0.0 && cosine >= 0.0 ? 0.0 : atan(sine, cosine) * level.pixels_per_radian;
}

// Octaves of area that a point loses by its angle away from the gaze.
float foveal_loss(vec3 at) {
  vec3 to = (at - level.camera_high.xyz) - level.camera_low.xyz;
  float angle = atan(length(cross(level.gaze.xyz, to)), dot(level.gaze.xyz, to));
  return level.foveation * max(angle - level.foveal_angle, 0.0);
}

// Heron's formula in Kahan's order, for slivers.
float triangle_area(float x, float y, float z) {
  float a = max(x, max(y, z));
  float c = min(x, min(y, z));
  float b = max(min(x, y), min(max(x, y), z));
  precise float square = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
  return 0.25 * sqrt(max(square, 0.0));
}

void main() {
  if (gl_GlobalInvocationID.x >= list[kListHeader - 1u]) return;
  uint patch_id = list[kListHeader + gl_GlobalInvocationID.x];
  bool held = marks[patch_id] == kHeld;
  marks[patch_id] = 0u;

  uint triangles = corners[patch_id].triangles;
  vec3 p0 = scene_position(corners[patch_id].position[0]);
  vec3 p1 = scene_position(corners[patch_id].position[1]);
  vec3 p2 = scene_position(corners[patch_id].position[2]);
  float e01 = edge_pixels(p0, p1);
  float e12 = edge_pixels(p1, p2);
  float e02 = edge_pixels(p0, p2);
  float area = 0.0;
  float width = 0.0;
  float height = 0.0;
  if (triangles == 1u) {
    area = 2.0 * triangle_area(e01, e12, e02);  // half of the block stays empty
    width = e01;
    height = e02;
  } else {
    vec3 p3 = scene_position(corners[patch_id].position[3]);
    float e23 = edge_pixels(p2, p3);
    float e03 = edge_pixels(p0, p3);
    if (triangles == 2u) {
      area = triangle_area(e01, e12, e02) + triangle_area(e02, e23, e03);
      width = max(e01, e23);
      height = max(e12, e03);
    } else {
      vec3 p4 = scene_position(corners[patch_id].position[4]);
      float e13 = edge_pixels(p1, p3);
      float e34 = edge_pixels(p3, p4);
      float e04 = edge_pixels(p0, p4);
      area = triangle_area(e01, e13, e03) + triangle_area(e12, e23, e13) + triangle_area(e03, e34, e04);
      width = max(e01, e23 + e34);  // the top side has a corner in its middle
      height = max(e12, e04);
    }
  }
  if (held && area > kMostHeldArea) return;  // an id pass does not miss it
  // Corners lie on the outer texels' centres ([SAS] fig. 6), so w texels make w - 1 steps: one more a side, but no
  // more than four times the area, for long slivers show few pixels.
  float side_u = sqrt(area * max(width, 1e-15) / max(height, 1e-15));
  float side_v = area / max(side_u, 1e-15);
  float bias = priorities[corners[patch_id].surface[0]] + priorities[corners[patch_id].surface[1]];
  if (level.foveation != 0.0) bias -= min(foveal_loss(p0), foveal_loss(p2));
  levels[patch_id] =
      pack_level(log2(min((side_u + 1.0) * (side_v + 1.0), 4.0 * max(area, 1e-30))) + bias,
                 log2((side_u + 1.0) / (side_v + 1.0)));
}
