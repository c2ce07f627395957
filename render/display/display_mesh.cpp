#include "render/display/display_mesh.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <glm/geometric.hpp>
#include <utility>

namespace atlaswire::render {
namespace {

void write(const Device& device, std::optional<Buffer>& buffer, const char* name,
           std::span<const std::byte> bytes, vk::BufferUsageFlags usage) {
  if (!buffer.has_value() || buffer->size() < bytes.size()) {
    buffer.emplace(device, BufferSettings{.name = name,
                                          .size = std::bit_ceil(bytes.size()),
                                          .usage = usage,
                                          .residence = Residence::kUpload});
  }
  std::memcpy(buffer->mapped().data(), bytes.data(), bytes.size());
  buffer->flush();
}

}  // namespace

void DisplayMesh::assign(const MeshData& mesh, const glm::dvec3& origin) {
  origin_ = origin;
  solid_ = mesh.solid;
  blended_ = mesh.blended;
  index_count_ = mesh.indices.size();
  if (empty()) return;
  write(*device_, vertices_, "display vertices", std::as_bytes(std::span(mesh.vertices)),
        vk::BufferUsageFlagBits::eVertexBuffer);
  write(*device_, indices_, "display indices", std::as_bytes(std::span(mesh.indices)),
        vk::BufferUsageFlagBits::eIndexBuffer);
}

void DisplayMesh::sort_blended(const glm::vec3& eye, std::vector<std::uint32_t>& indices) const {
  indices.clear();
  if (blended_.empty()) return;
  std::vector<std::pair<float, const MeshData::Blended*>> order;
  order.reserve(blended_.size());
  for (const MeshData::Blended& b : blended_) {
    const glm::vec3 away = b.centre - eye;
    order.emplace_back(glm::dot(away, away), &b);
  }
  std::ranges::stable_sort(order, std::ranges::greater{}, &std::pair<float, const MeshData::Blended*>::first);

  const auto vertices = vertices_->mapped<DisplayVertex>();
  const auto all = indices_->mapped<std::uint32_t>();
  for (const auto& [distance2, patch] : order) {
    for (std::uint32_t i = patch->range.first; i < patch->range.first + patch->range.count; i += 3) {
      const glm::vec3 a = vertices[all[i]].position;
      const glm::vec3 normal =
          glm::cross(vertices[all[i + 1]].position - a, vertices[all[i + 2]].position - a);
      if (!patch->double_sided && glm::dot(normal, eye - a) <= 0.0F) continue;
      indices.insert(indices.end(), {all[i], all[i + 1], all[i + 2]});
    }
  }
}

}  // namespace atlaswire::render
