#version 460
// Writes the patch that a pixel shows.

layout(location = 0) flat in uint patch_id;
layout(location = 0) out uint id;

void main() { id = patch_id; }
