#pragma once

#include "base/result.h"

#include <cstdint>
#include <vector>

namespace tinygltf {
class Model;
}

namespace atlaswire::render {

/// An accessor's elements as floats, `components` each (normalized integers become 0..1 or -1..1), sparse
/// substitution applied; every offset is checked. Errors: kIndexOutOfRange, kBadAccessor.
Result<std::vector<float>> read_floats(const tinygltf::Model& model, int accessor, std::uint32_t components);

/// An accessor's elements as unsigned indices. Errors as above.
Result<std::vector<std::uint32_t>> read_indices(const tinygltf::Model& model, int accessor);

}  // namespace atlaswire::render
