#version 460
#extension GL_GOOGLE_include_directive : require
// The farthest depth of each tile of the id pass so far: of 8 x 8 pixels, or, coarse, of 8 x 8 tiles. With
// reversed-Z the farthest is the smallest.
#include "shaders/visibility_layout.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant) uniform Grid { GridConstants grid; };
layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1, std430) buffer Farthest { float farthest[]; };

float of_pixels(uvec2 tile) {
  // Gathers at the corner that 2 x 2 pixels share; past the border the sampler repeats the last pixel.
  float least = 1.0;
  for (uint y = 1u; y < kFineTile; y += 2u) {
    for (uint x = 1u; x < kFineTile; x += 2u) {
      vec4 four = textureGather(depth, vec2(tile * kFineTile + uvec2(x, y)) / vec2(grid.extent));
      least = min(least, min(min(four.x, four.y), min(four.z, four.w)));
    }
  }
  return least;
}

float of_tiles(uvec2 tile, uvec2 tiles) {
  float least = 1.0;
  uvec2 end = min((tile + 1u) * kCoarseTile, tiles);
  for (uint y = tile.y * kCoarseTile; y < end.y; ++y) {
    for (uint x = tile.x * kCoarseTile; x < end.x; ++x) least = min(least, farthest[y * tiles.x + x]);
  }
  return least;
}

void main() {
  uvec2 tile = gl_GlobalInvocationID.xy;
  uvec2 tiles = (grid.extent + kFineTile - 1u) / kFineTile;
  if (grid.coarse == 0u) {
    if (all(lessThan(tile, tiles))) farthest[tile.y * tiles.x + tile.x] = of_pixels(tile);
    return;
  }
  uvec2 coarse = (tiles + kCoarseTile - 1u) / kCoarseTile;
  if (all(lessThan(tile, coarse))) {
    farthest[tiles.x * tiles.y + tile.y * coarse.x + tile.x] = of_tiles(tile, tiles);
  }
}
