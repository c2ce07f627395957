#include "render/passes/visibility_geometry.h"

#include "render/gpu/barriers.h"
#include "shaders/visibility_layout.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace atlaswire::render {
namespace {

using Usage = vk::BufferUsageFlagBits;

Buffer device_buffer(const Device& device, const char* name, std::size_t bytes, vk::BufferUsageFlags usage) {
  return {device, {.name = name, .size = bytes, .usage = usage | Usage::eTransferDst}};
}

std::vector<std::uint32_t> position_indices(const Scene& scene) {
  std::vector<std::uint32_t> indices;
  indices.reserve(scene.indices.size());
  for (const Patch& patch : scene.patches) {
    for (std::uint32_t t = 0; t < patch.triangles; ++t) {
      for (const std::uint8_t corner : patch_triangle(patch.triangles, t)) {
        indices.push_back(value(patch.positions[corner]));
      }
    }
  }
  return indices;
}

std::vector<visibility::PatchCorners> patch_corners(const Scene& scene) {
  std::vector<visibility::PatchCorners> corners;
  corners.reserve(scene.patches.size());
  for (const Patch& patch : scene.patches) {
    visibility::PatchCorners& next = corners.emplace_back();
    std::ranges::transform(patch.positions, next.position, [](VertexId id) { return value(id); });
    next.triangles = patch.triangles;
  }
  return corners;
}

/// Copies host data through a staging buffer and waits.
template <class T>
void upload(SubmitContext& context, const Buffer& target, const std::vector<T>& data) {
  const std::size_t bytes = data.size() * sizeof(T);
  if (bytes == 0) return;
  const Buffer staging(context.device(), {.name = "visibility staging",
                                          .size = bytes,
                                          .usage = Usage::eTransferSrc,
                                          .residence = Residence::kUpload});
  std::memcpy(staging.mapped().data(), data.data(), bytes);
  staging.flush();
  context.run([&](const vk::raii::CommandBuffer& commands) {
    commands.copyBuffer(staging.handle(), target.handle(), vk::BufferCopy{.size = bytes});
  });
}

}  // namespace

VisibilityGeometry::VisibilityGeometry(Device& device, const Scene& scene)
    : positions(device_buffer(device, "positions", scene.positions.size() * sizeof(glm::vec3),
                              Usage::eVertexBuffer | Usage::eStorageBuffer)),
      indices(device_buffer(device, "position indices", scene.indices.size() * sizeof(std::uint32_t),
                            Usage::eIndexBuffer)),
      corners(device_buffer(device, "patch corners", scene.patches.size() * sizeof(visibility::PatchCorners),
                            Usage::eStorageBuffer)),
      marks(device_buffer(device, "patch marks", scene.patches.size() * sizeof(std::uint32_t),
                          Usage::eStorageBuffer)),
      list(device_buffer(device, "visible patches",
                         (visibility::kListHeader + scene.patches.size()) * sizeof(std::uint32_t),
                         Usage::eStorageBuffer | Usage::eIndirectBuffer)),
      levels(device, {.name = "patch levels",
                      .size = scene.patches.size() * sizeof(std::uint32_t),
                      .usage = Usage::eStorageBuffer | Usage::eTransferDst,
                      .residence = Residence::kReadback}) {
  SubmitContext context(device, "visibility upload", 1);
  upload(context, positions, scene.positions);
  upload(context, indices, position_indices(scene));
  upload(context, corners, patch_corners(scene));
  context.run([&](const vk::raii::CommandBuffer& commands) {
    commands.fillBuffer(marks.handle(), 0, VK_WHOLE_SIZE, 0);
    transfer_to_shaders(commands);
  });
  std::ranges::fill(levels.mapped<std::uint32_t>(), 0U);
  levels.flush();
}

}  // namespace atlaswire::render
