#pragma once

#include "base/result.h"
#include "render/scene/source.h"

namespace tinygltf {
class Model;
}

namespace atlaswire::render {

/// Materials and the textures they use, appended to `source`; material i of the file becomes material i, and
/// one plain material follows for primitives without any. An image used both as colour and as data becomes
/// two textures. Errors: kIndexOutOfRange, kBadImage, kTooLarge.
Result<void> read_materials(const tinygltf::Model& model, SceneSource& source);

}  // namespace atlaswire::render
