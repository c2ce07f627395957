#pragma once

#include "base/result.h"
#include "render/scene/assemble.h"
#include "render/scene/scene.h"

#include <string>
#include <vector>

namespace atlaswire::render {

/// Scenes that need no file; "atrium" may carry options ("atrium:0.2:lights=64", see AtriumOptions).
std::vector<std::string> builtin_scenes();

/// A built-in scene by name, or a glTF 2.0 file (.gltf or .glb). Errors: SceneError, naming file and part.
Result<Scene> load_scene(const std::string& name_or_file, const AssembleSettings& settings = {});

}  // namespace atlaswire::render
