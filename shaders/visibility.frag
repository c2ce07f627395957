#version 460
// Writes the triangle that a pixel shows. Which patch that is, the mark pass looks up: seldom, where ids change,
// and not for each pixel.

layout(location = 0) flat in uint first_triangle;
layout(location = 0) out uint triangle;

void main() { triangle = first_triangle + uint(gl_PrimitiveID); }
