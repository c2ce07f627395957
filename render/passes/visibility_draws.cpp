#include "render/passes/visibility_draws.h"

namespace atlaswire::render {
namespace {

bool same_range(const DrawRange& range, const Material& material, std::uint16_t index) {
  const IdClass kind = id_class(material);
  return range.id_class == kind && range.double_sided == material.draw.double_sided &&
         (kind == IdClass::kOpaque || range.material == index);
}

visibility::ChunkCandidate candidate(const Chunk& chunk, const Box& box) {
  return {.low = glm::vec4(box.low, 0),
          .high = glm::vec4(box.high, 0),
          .index_count = 3 * chunk.triangle_count,
          .first_index = 3 * chunk.first_triangle,
          .padding = {}};
}

}  // namespace

IdClass id_class(const Material& material) {
  switch (material.draw.alpha) {
    case PatchClass::Alpha::kMask:
      return IdClass::kMasked;
    case PatchClass::Alpha::kBlend:
      return IdClass::kBlended;
    default:
      return IdClass::kOpaque;
  }
}

DrawList list_draws(const Scene& scene, std::span<const Box> boxes, std::span<const std::uint32_t> chunks,
                    bool merge) {
  DrawList list;
  for (const std::uint32_t index : chunks) {
    const Chunk& chunk = scene.chunks[index];
    if (chunk.triangle_count == 0) continue;
    const Material& material = scene.materials[chunk.material];
    if (list.ranges.empty() || !same_range(list.ranges.back(), material, chunk.material)) {
      list.ranges.push_back({.id_class = id_class(material),
                             .double_sided = material.draw.double_sided,
                             .material = chunk.material,
                             .first_command = static_cast<std::uint32_t>(list.candidates.size()),
                             .command_count = 0});
    }
    DrawRange& range = list.ranges.back();
    const visibility::ChunkCandidate next = candidate(chunk, boxes[index]);
    if (merge && range.command_count > 0) {
      visibility::ChunkCandidate& last = list.candidates.back();
      if (last.first_index + last.index_count == next.first_index) {
        last.index_count += next.index_count;
        last.low = glm::min(last.low, next.low);
        last.high = glm::max(last.high, next.high);
        continue;
      }
    }
    list.candidates.push_back(next);
    ++range.command_count;
  }
  return list;
}

}  // namespace atlaswire::render
