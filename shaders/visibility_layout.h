// What the visibility passes and render/passes/visibility.cpp share. Included by GLSL and by C++.
#ifndef ATLASWIRE_SHADERS_VISIBILITY_LAYOUT_H
#define ATLASWIRE_SHADERS_VISIBILITY_LAYOUT_H

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
namespace atlaswire::render::visibility {
using mat4 = glm::mat4;
using vec2 = glm::vec2;
using vec4 = glm::vec4;
using uvec2 = glm::uvec2;
using uint = std::uint32_t;
#define AW_CONST inline constexpr std::uint32_t
#else
#define AW_CONST const uint
#endif

/// The id of a pixel that shows nothing.
AW_CONST kNoPatch = 0xffffffffu;
/// Invocations of a work group of the passes over patches and chunks.
AW_CONST kListGroup = 64u;
/// What a mark says: seen in this frame, or held from an earlier one. 0: neither.
AW_CONST kSeen = 1u;
AW_CONST kHeld = 2u;
/// Pixels that one invocation of the mark pass reads, side by side; at most 32.
AW_CONST kMarkRun = 8u;
/// Words before the list of visible patches: the level pass's groups (x, y, z), and the list's length.
AW_CONST kListHeader = 4u;
/// The grid of farthest depths that chunks are tested against: a fine tile's side in pixels, and a coarse
/// tile's in fine tiles. Fine tiles come first in the buffer, row by row, then coarse ones.
AW_CONST kFineTile = 8u;
AW_CONST kCoarseTile = 8u;

/// Push constants of the id pass: one view.
struct ViewConstants {
  mat4 clip_from_relative;  // projection times rotation
  vec4 camera_high;         // camera relative to the scene's origin, rounded to float
  vec4 camera_low;          // what that rounding lost
};

/// Push constants of the chunk test: the view, and what it tests.
struct CullConstants {
  ViewConstants view;
  uvec2 extent;  // of the id buffer, pixels
  uint first;    // candidate of this view
  uint count;
};

/// Push constants of the passes that make the grid.
struct GridConstants {
  uvec2 extent;  // of the id buffer, pixels
  uint coarse;   // 1: make the coarse tiles from the fine ones
  uint padding;
};

/// Push constants of the level pass: the current pose, and where it looks.
struct LevelConstants {
  vec4 camera_high;
  vec4 camera_low;
  float pixels_per_radian;  // of the display, at its centre: half its height over tan(half its field of view)
  float foveation;          // octaves of area lost per radian away from the gaze
  float foveal_angle;       // radians around the gaze where none are
  uint padding;
  vec4 gaze;  // xyz: unit
};

/// Push constants of the hold pass.
struct HoldConstants {
  uint patches;
  uint frames;  // that a patch counts as visible after it was last seen
};

/// A patch's corners in the position buffer, how many triangles they make, and where its priority is.
struct PatchCorners {
  uint position[5];
  uint triangles;
  uint surface[2];  // material and object: into the priorities, octaves of area that add up
};

/// A chunk that may be drawn: its box and its part of the index buffer.
struct ChunkCandidate {
  vec4 low;  // xyz relative to the scene's origin
  vec4 high;
  uint index_count;
  uint first_index;
  uint padding[2];
};

/// VkDrawIndexedIndirectCommand.
struct DrawCommand {
  uint index_count;
  uint instance_count;
  uint first_index;
  int vertex_offset;
  uint first_instance;
};

#undef AW_CONST
#ifdef __cplusplus
static_assert(sizeof(ViewConstants) == 96 && offsetof(ViewConstants, camera_low) == 80);
static_assert(sizeof(CullConstants) == 112 && offsetof(CullConstants, extent) == 96);
static_assert(sizeof(GridConstants) == 16 && offsetof(GridConstants, coarse) == 8);
static_assert(sizeof(LevelConstants) == 64 && offsetof(LevelConstants, pixels_per_radian) == 32);
static_assert(sizeof(HoldConstants) == 8 && offsetof(HoldConstants, frames) == 4);
static_assert(sizeof(PatchCorners) == 32 && offsetof(PatchCorners, surface) == 24);
static_assert(sizeof(ChunkCandidate) == 48 && offsetof(ChunkCandidate, index_count) == 32);
static_assert(sizeof(DrawCommand) == 20 && offsetof(DrawCommand, first_instance) == 16);
}  // namespace atlaswire::render::visibility
#endif

#endif  // ATLASWIRE_SHADERS_VISIBILITY_LAYOUT_H
