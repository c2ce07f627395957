#pragma once

#include "render/display/mesh_builder.h"
#include "render/gpu/buffer.h"

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace atlaswire::render {

/// A mesh of pre-shaded triangles on the device. Keep one for each pair that may be drawn or built, as with
/// AtlasTexture's slots: assign() while no draw of it is pending.
class DisplayMesh {
 public:
  explicit DisplayMesh(const Device& device) : device_(&device) {}

  /// Takes over the mesh's contents; positions are relative to `origin` in scene coordinates.
  void assign(const MeshData& mesh, const glm::dvec3& origin);

  [[nodiscard]] const glm::dvec3& origin() const { return origin_; }
  [[nodiscard]] bool empty() const { return index_count_ == 0; }
  /// Only when not empty().
  [[nodiscard]] const Buffer& vertices() const { return *vertices_; }
  [[nodiscard]] const Buffer& indices() const { return *indices_; }
  [[nodiscard]] MeshData::Range solid(PatchClass::Alpha alpha, bool double_sided) const {
    return solid_[static_cast<std::size_t>(alpha)][double_sided ? 1 : 0];
  }

  /// Indices of the blended patches from far to near as seen from `eye` (relative to the origin);
  /// single-sided triangles that face away are left out.
  void sort_blended(const glm::vec3& eye, std::vector<std::uint32_t>& indices) const;
  [[nodiscard]] bool has_blended() const { return !blended_.empty(); }

 private:
  const Device* device_;
  glm::dvec3 origin_{0.0};
  std::size_t index_count_ = 0;
  std::optional<Buffer> vertices_;
  std::optional<Buffer> indices_;
  decltype(MeshData::solid) solid_{};
  std::vector<MeshData::Blended> blended_;
};

}  // namespace atlaswire::render
