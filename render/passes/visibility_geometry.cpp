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

std::vector<visibility::PatchCorners> patch_corners(const Scene& scene) {
  std::vector<visibility::PatchCorners> corners;
  corners.reserve(scene.patches.size());
  for (const Patch& patch : scene.patches) {
    visibility::PatchCorners& next = corners.emplace_back();
    std::ranges::transform(patch.positions, next.position, [](VertexId id) { return value(id); });
    next.triangles = patch.triangles;
    next.surface[0] = patch.material;
    next.surface[1] = static_cast<std::uint32_t>(scene.materials.size()) + patch.object;
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
    : VisibilityGeometry(device, scene, make_id_mesh(scene)) {}

VisibilityGeometry::VisibilityGeometry(Device& device, const Scene& scene, const IdMesh& mesh)
    : solid(device_buffer(device, "solid id vertices", mesh.solid.size() * sizeof(IdVertex),
                          Usage::eVertexBuffer)),
      cut(device_buffer(device, "cut id vertices", mesh.cut.size() * sizeof(CutVertex),
                        Usage::eVertexBuffer)),
      indices(device_buffer(device, "id indices", mesh.indices.size() * sizeof(std::uint32_t),
                            Usage::eIndexBuffer)),
      positions(device_buffer(device, "positions", scene.positions.size() * sizeof(glm::vec3),
                              Usage::eStorageBuffer)),
      corners(device_buffer(device, "patch corners", scene.patches.size() * sizeof(visibility::PatchCorners),
                            Usage::eStorageBuffer)),
      marks(device_buffer(device, "patch marks", scene.patches.size() * sizeof(std::uint32_t),
                          Usage::eStorageBuffer)),
      held(device_buffer(device, "held patches", scene.patches.size() * sizeof(std::uint32_t),
                         Usage::eStorageBuffer)),
      list(device_buffer(device, "visible patches",
                         (visibility::kListHeader + scene.patches.size()) * sizeof(std::uint32_t),
                         Usage::eStorageBuffer | Usage::eIndirectBuffer)),
      priorities(device, {.name = "surface priorities",
                          .size = (scene.materials.size() + std::max<std::size_t>(1, scene.objects.size())) *
                                  sizeof(float),
                          .usage = Usage::eStorageBuffer,
                          .residence = Residence::kUpload}),
      levels(device, {.name = "patch levels",
                      .size = scene.patches.size() * sizeof(std::uint32_t),
                      .usage = Usage::eStorageBuffer | Usage::eTransferDst,
                      .residence = Residence::kReadback}) {
  SubmitContext context(device, "visibility upload", 1);
  upload(context, solid, mesh.solid);
  upload(context, cut, mesh.cut);
  upload(context, indices, mesh.indices);
  upload(context, positions, scene.positions);
  upload(context, corners, patch_corners(scene));
  context.run([&](const vk::raii::CommandBuffer& commands) {
    commands.fillBuffer(marks.handle(), 0, VK_WHOLE_SIZE, 0);
    commands.fillBuffer(held.handle(), 0, VK_WHOLE_SIZE, 0);
    transfer_to_shaders(commands);
  });
  std::ranges::fill(priorities.mapped<float>(), 0.0F);
  priorities.flush();
  std::ranges::fill(levels.mapped<std::uint32_t>(), 0U);
  levels.flush();
}

}  // namespace atlaswire::render
