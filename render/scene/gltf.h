#pragma once

#include "base/result.h"
#include "render/scene/source.h"

#include <string>

namespace atlaswire::render {

/// Reads a glTF 2.0 file, .gltf (with its buffers and images beside it) or .glb: node hierarchy, instancing,
/// metallic-roughness materials, alpha modes, double-sidedness, KHR_lights_punctual, KHR_materials_unlit
/// (as emission) and KHR_materials_emissive_strength. Animations, with skins and morph targets, become
/// the source's rig (animator.h plays it); its meshes are as they rest. Missing normals and tangents are
/// computed. A scene without lights gets a sun and sky. Trusts nothing in the file. Errors: SceneError.
Result<SceneSource> read_gltf(const std::string& file);

}  // namespace atlaswire::render
