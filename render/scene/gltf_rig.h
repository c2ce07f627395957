#pragma once

#include "base/result.h"
#include "render/scene/source.h"

#include <cstdint>
#include <vector>

namespace tinygltf {
class Model;
struct Primitive;
}  // namespace tinygltf

namespace atlaswire::render {

/// Joints, weights (the first four of each vertex) and morph targets' positions of a primitive with so many
/// vertices. Errors: kIndexOutOfRange, kBadAccessor, kNotFinite, kTooLarge.
Result<RigMesh> read_rig_mesh(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                              std::size_t vertices);

/// Nodes, clips and skins of a file with animations; `rig` has its meshes and instances already, which are
/// checked against the skins. Channels of unknown properties and those of nodes with a matrix are left out
/// with a warning. Trusts nothing. Errors: kMalformed, kIndexOutOfRange, kBadAccessor, kNotFinite, kTooLarge.
Result<void> read_rig(const tinygltf::Model& model, const std::vector<SourceInstance>& instances, Rig& rig);

}  // namespace atlaswire::render
