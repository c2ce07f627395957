#version 460
#extension GL_GOOGLE_include_directive : require
// The source's colour where the moved grid puts it.
#include "shaders/warp.glsl"

layout(location = 0) in vec2 source_pixel;
layout(location = 0) out vec4 color;

void main() { color = source_color(source_pixel); }
