#version 460
#extension GL_GOOGLE_include_directive : require
// The fragment stage of the shading pass (into the atlas) and of the forward pass (into the ground truth).
#include "shaders/material.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 uv;
layout(location = 4) flat in uint light_list;

layout(location = 0) out vec4 color;

void main() { color = evaluate_material(SurfacePoint(position, normal, tangent, uv, light_list)); }
