#include "render/scene/gltf_accessor.h"

#include "render/scene/scene_error.h"
#include "render/scene/tinygltf_include.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

namespace atlaswire::render {

namespace {

/// A checked run of elements in a buffer.
struct Elements {
  const unsigned char* first = nullptr;
  std::size_t stride = 0;
};

Error bad(int accessor, const char* why) {
  return Error{SceneError::kBadAccessor, "accessor " + std::to_string(accessor) + " " + why};
}

/// `count` elements of `size` octets at `offset` of a view, or an Error when any lies outside it.
Result<Elements> elements(const tinygltf::Model& model, int accessor, int view_index, std::size_t offset,
                          std::size_t count, std::size_t size, bool packed) {
  if (view_index < 0 || static_cast<std::size_t>(view_index) >= model.bufferViews.size()) {
    return bad(accessor, "names a buffer view that is not there");
  }
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(view_index)];
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size()) {
    return bad(accessor, "names a buffer that is not there");
  }
  const auto& data = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
    return bad(accessor, "has a buffer view that reaches beyond its buffer");
  }
  const std::size_t stride = packed || view.byteStride == 0 ? size : view.byteStride;
  if (stride < size) return bad(accessor, "has a stride smaller than its elements");
  if (count > 0) {
    if (offset > view.byteLength || size > view.byteLength - offset ||
        (count - 1) > (view.byteLength - offset - size) / stride) {
      return bad(accessor, "reaches beyond its buffer view");
    }
  }
  return Elements{data.data() + view.byteOffset + offset, stride};
}

template <class T>
T load(const unsigned char* at) {
  T v;
  std::memcpy(&v, at, sizeof(T));
  return v;
}

float component(const unsigned char* at, int type, bool normalized) {
  const auto scaled = [normalized](float v, float top) { return normalized ? std::max(v / top, -1.0F) : v; };
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return scaled(static_cast<float>(load<std::int8_t>(at)), 127.0F);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return scaled(static_cast<float>(load<std::uint8_t>(at)), 255.0F);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return scaled(static_cast<float>(load<std::int16_t>(at)), 32767.0F);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return scaled(static_cast<float>(load<std::uint16_t>(at)), 65535.0F);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return static_cast<float>(load<std::uint32_t>(at));
    default:
      return load<float>(at);
  }
}

/// Octets of one component, 0 for a type glTF does not have.
std::size_t component_size(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

std::uint32_t index_of(const unsigned char* at, std::size_t size) {
  return size == 1 ? load<std::uint8_t>(at) : size == 2 ? load<std::uint16_t>(at) : load<std::uint32_t>(at);
}

Result<const tinygltf::Accessor*> find(const tinygltf::Model& model, int accessor) {
  if (accessor < 0 || static_cast<std::size_t>(accessor) >= model.accessors.size()) {
    return Error{SceneError::kIndexOutOfRange, "accessor " + std::to_string(accessor)};
  }
  const tinygltf::Accessor& found = model.accessors[static_cast<std::size_t>(accessor)];
  constexpr std::size_t kMostElements = 256ULL * 1024 * 1024;
  if (found.count > kMostElements) return bad(accessor, "has more than 268 million elements");
  if (component_size(found.componentType) == 0) return bad(accessor, "has an unknown component type");
  return &found;
}

std::optional<Error> substitute(const tinygltf::Model& model, int accessor, const tinygltf::Accessor& a,
                                std::uint32_t components, std::vector<float>& out) {
  if (!a.sparse.isSparse) return std::nullopt;
  const auto count = static_cast<std::size_t>(std::max(a.sparse.count, 0));
  const std::size_t index_size = component_size(a.sparse.indices.componentType);
  const std::size_t size = component_size(a.componentType);
  if (index_size == 0) return bad(accessor, "has sparse indices of an unknown type");
  if (a.sparse.indices.byteOffset < 0 || a.sparse.values.byteOffset < 0)
    return bad(accessor, "has a negative sparse offset");
  const auto indices =
      elements(model, accessor, a.sparse.indices.bufferView,
               static_cast<std::size_t>(a.sparse.indices.byteOffset), count, index_size, true);
  if (indices.has_error()) return indices.error();
  const auto values =
      elements(model, accessor, a.sparse.values.bufferView,
               static_cast<std::size_t>(a.sparse.values.byteOffset), count, size * components, true);
  if (values.has_error()) return values.error();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = index_of(indices->first + i * indices->stride, index_size);
    if (at >= a.count) return bad(accessor, "has a sparse index beyond its count");
    for (std::size_t c = 0; c < components; ++c) {
      out[at * components + c] =
          component(values->first + i * values->stride + c * size, a.componentType, a.normalized);
    }
  }
  return std::nullopt;
}

}  // namespace

Result<std::vector<float>> read_floats(const tinygltf::Model& model, int accessor, std::uint32_t components) {
  const auto found = find(model, accessor);
  if (found.has_error()) return found.error();
  const tinygltf::Accessor& a = **found;
  if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a.type)) != static_cast<int>(components)) {
    return bad(accessor, "has the wrong number of components");
  }
  const std::size_t size = component_size(a.componentType);
  std::vector<float> out;
  if (a.bufferView >= 0) {
    const auto run = elements(model, accessor, a.bufferView, a.byteOffset, a.count, size * components, false);
    if (run.has_error()) return run.error();
    out.resize(a.count * components);
    for (std::size_t i = 0; i < a.count; ++i) {
      for (std::size_t c = 0; c < components; ++c) {
        out[i * components + c] =
            component(run->first + i * run->stride + c * size, a.componentType, a.normalized);
      }
    }
  } else {
    out.resize(a.count * components, 0.0F);
  }
  if (auto error = substitute(model, accessor, a, components, out)) return *error;
  return out;
}

Result<std::vector<std::uint32_t>> read_indices(const tinygltf::Model& model, int accessor) {
  const auto found = find(model, accessor);
  if (found.has_error()) return found.error();
  const tinygltf::Accessor& a = **found;
  const bool is_unsigned = a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                           a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                           a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (a.type != TINYGLTF_TYPE_SCALAR || !is_unsigned || a.sparse.isSparse)
    return bad(accessor, "is no list of indices");
  const std::size_t size = component_size(a.componentType);
  const auto run = elements(model, accessor, a.bufferView, a.byteOffset, a.count, size, false);
  if (run.has_error()) return run.error();
  std::vector<std::uint32_t> out(a.count);
  for (std::size_t i = 0; i < a.count; ++i) out[i] = index_of(run->first + i * run->stride, size);
  return out;
}

}  // namespace atlaswire::render
