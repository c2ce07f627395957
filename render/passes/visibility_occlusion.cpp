#include "render/passes/visibility_occlusion.h"

#include "base/assert.h"
#include "render/gpu/barriers.h"
#include "shaders/shaders.h"

#include <algorithm>

namespace atlaswire::render {
namespace {

using Usage = vk::BufferUsageFlagBits;

std::vector<Binding> bindings() {
  return {{.binding = 0, .type = vk::DescriptorType::eCombinedImageSampler},
          {.binding = 1},
          {.binding = 2},
          {.binding = 3}};
}

Extent2D tiles_over(Extent2D extent, std::uint32_t side) {
  return {group_count(extent.width, side), group_count(extent.height, side)};
}

}  // namespace

ChunkOcclusion::ChunkOcclusion(const Device& device, std::uint32_t capacity)
    : device_(&device),
      layout_(device, "occlusion", bindings()),
      sets_(device, "occlusion", layout_),
      grid_pipeline_(device, ComputeSettings{.name = "depth grid",
                                             .shader = shaders::visibility_grid_comp,
                                             .layouts = {layout_.handle()},
                                             .push_constant_bytes = sizeof(visibility::GridConstants)}),
      cull_pipeline_(device, ComputeSettings{.name = "chunk test",
                                             .shader = shaders::visibility_cull_comp,
                                             .layouts = {layout_.handle()},
                                             .push_constant_bytes = sizeof(visibility::CullConstants)}),
      sampler_(make_sampler(device, {.name = "depth gather", .filter = vk::Filter::eNearest})),
      candidates_(device, {.name = "chunk candidates",
                           .size = capacity * sizeof(visibility::ChunkCandidate),
                           .usage = Usage::eStorageBuffer,
                           .residence = Residence::kUpload}),
      commands_(device, {.name = "tested draws",
                         .size = capacity * sizeof(visibility::DrawCommand),
                         .usage = Usage::eStorageBuffer | Usage::eIndirectBuffer}) {
  sets_.write(0, 2, candidates_);
  sets_.write(0, 3, commands_);
}

void ChunkOcclusion::set_depth(const Image& depth) {
  const Extent2D fine = tiles_over(depth.extent(), visibility::kFineTile);
  const Extent2D coarse = tiles_over(fine, visibility::kCoarseTile);
  grid_.emplace(*device_, BufferSettings{.name = "depth grid",
                                         .size = (fine.area() + coarse.area()) * sizeof(float),
                                         .usage = Usage::eStorageBuffer});
  sets_.write(0, 0, depth, sampler_);
  sets_.write(0, 1, *grid_);
}

void ChunkOcclusion::record(const vk::raii::CommandBuffer& commands, Image& depth,
                            const visibility::ViewConstants& view, const DrawList& list,
                            std::uint32_t first) {
  const auto target = candidates_.mapped<visibility::ChunkCandidate>();
  const auto count = static_cast<std::uint32_t>(list.candidates.size());
  AW_ASSERT(grid_.has_value() && first + count <= target.size());
  std::ranges::copy(list.candidates, target.begin() + first);
  candidates_.flush();

  use_image(commands, depth, ImageUse::kSampledInCompute);
  const glm::uvec2 extent{depth.extent().width, depth.extent().height};
  const Extent2D fine = tiles_over(depth.extent(), visibility::kFineTile);
  const Extent2D coarse = tiles_over(fine, visibility::kCoarseTile);
  grid_pipeline_.bind(commands, {sets_.handle()});
  grid_pipeline_.push(commands, visibility::GridConstants{.extent = extent, .coarse = 0, .padding = 0});
  commands.dispatch(group_count(fine.width, 8), group_count(fine.height, 8), 1);
  compute_to_compute(commands);
  grid_pipeline_.push(commands, visibility::GridConstants{.extent = extent, .coarse = 1, .padding = 0});
  commands.dispatch(group_count(coarse.width, 8), group_count(coarse.height, 8), 1);
  compute_to_compute(commands);
  cull_pipeline_.bind(commands, {sets_.handle()});
  cull_pipeline_.push(
      commands, visibility::CullConstants{.view = view, .extent = extent, .first = first, .count = count});
  commands.dispatch(group_count(count, visibility::kListGroup), 1, 1);
  compute_to_draw(commands);
}

}  // namespace atlaswire::render
