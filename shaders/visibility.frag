#version 460
#extension GL_GOOGLE_include_directive : require
// Writes the patch that a pixel shows.

layout(set = 0, binding = 0, std430) readonly buffer TrianglePatch { uint triangle_patch[]; };

layout(location = 0) flat in uint first_triangle;
layout(location = 0) out uint patch_id;

void main() { patch_id = triangle_patch[first_triangle + uint(gl_PrimitiveID)]; }
