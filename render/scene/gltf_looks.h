#pragma once

#include "base/result.h"
#include "render/scene/source.h"

#include <optional>

namespace tinygltf {
class Model;
class Value;
}  // namespace tinygltf

namespace atlaswire::render {

/// Materials and the textures they use, appended to `source`; material i of the file becomes material i, and
/// one plain material follows for primitives without any. An image used both as colour and as data becomes
/// two textures. Errors: kIndexOutOfRange, kBadImage, kTooLarge.
Result<void> read_materials(const tinygltf::Model& model, SceneSource& source);

/// "extras": {"atlas_priority": OCTAVES} of a material or node, clamped to -8..8; nullopt where it is absent
/// or no finite number.
std::optional<float> atlas_priority(const tinygltf::Value& extras);

}  // namespace atlaswire::render
