#include "render/atlas_gpu/device_selector.h"

#include "render/gpu/barriers.h"
#include "render/gpu/submit_context.h"
#include "shaders/shaders.h"

#include <string>

namespace atlaswire::render {
namespace {

using namespace select;

SelectConstants constants_of(const LevelRange& range, const LevelSettings& s, std::uint32_t patches) {
  return {.patches = patches,
          .smallest = range.smallest,
          .largest = range.largest,
          .lowest_bin = range.lowest_bin,
          .highest_bin = range.highest_bin,
          .lowest_step = range.lowest_step,
          .highest_step = range.highest_step,
          .margin = range.margin,
          .target = static_cast<uint>(range.target >> (2 * s.allocator.min_block_log2))};
}

Buffer words(Device& device, const char* name, std::size_t count, Residence residence) {
  return {device,
          {.name = std::string("level selection: ") + name,
           .size = count * sizeof(uint),
           .usage = vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst |
                    vk::BufferUsageFlagBits::eIndirectBuffer,
           .residence = residence}};
}

Pipeline pass(Device& device, const DescriptorLayout& layout, const char* name, ShaderWords shader) {
  return {device, ComputeSettings{.name = std::string("level selection: ") + name,
                                  .shader = shader,
                                  .layouts = {layout.handle()},
                                  .push_constant_bytes = sizeof(SelectConstants)}};
}

}  // namespace

DeviceSelector::DeviceSelector(Device& device, const LevelSettings& settings, std::uint32_t patch_count,
                               const Buffer& levels, const Buffer& wants)
    : constants_(constants_of(level_range(settings), settings, patch_count)),
      unit_log2_(2 * settings.allocator.min_block_log2),
      selection_(words(device, "state", sizeof(Selection) / sizeof(uint), Residence::kReadback)),
      remembered_(words(device, "remembered", patch_count, Residence::kDevice)),
      savings_(words(device, "savings", 2 * std::size_t{group_count(patch_count, 32)}, Residence::kDevice)),
      layout_(device, "level selection",
              {{.binding = 0}, {.binding = 1}, {.binding = 2}, {.binding = 3}, {.binding = 4}}),
      sets_(device, "level selection", layout_),
      count_(pass(device, layout_, "count", shaders::select_count_comp)),
      bias_(pass(device, layout_, "bias", shaders::select_bias_comp)),
      want_(pass(device, layout_, "want", shaders::select_want_comp)),
      excess_(pass(device, layout_, "excess", shaders::select_excess_comp)),
      demote_(pass(device, layout_, "demote", shaders::select_demote_comp)) {
  sets_.write(0, 0, selection_);
  sets_.write(0, 1, levels);
  sets_.write(0, 2, wants);
  sets_.write(0, 3, remembered_);
  sets_.write(0, 4, savings_);
  Selection& initial = selection_.mapped<Selection>()[0];
  initial = {};
  initial.demote_groups[1] = initial.demote_groups[2] = 1;
  selection_.flush();
  SubmitContext(device, "level selection").run([&](const vk::raii::CommandBuffer& commands) {
    commands.fillBuffer(remembered_.handle(), 0, VK_WHOLE_SIZE, 0);
    transfer_to_shaders(commands);
  });
}

void DeviceSelector::record(const vk::raii::CommandBuffer& commands) const {
  const std::uint32_t groups = group_count(constants_.patches, kSelectGroup);
  const auto run = [&](const Pipeline& pipeline, std::uint32_t count) {
    pipeline.bind(commands, {sets_.handle()});
    pipeline.push(commands, constants_);
    commands.dispatch(count, 1, 1);
    compute_to_compute(commands);
  };
  run(count_, groups);
  run(bias_, 1);
  run(want_, groups);
  run(excess_, 1);
  compute_to_draw(commands);  // the next pass's extent comes from that one
  demote_.bind(commands, {sets_.handle()});
  demote_.push(commands, constants_);
  commands.dispatchIndirect(selection_.handle(), offsetof(Selection, demote_groups));
  compute_to_compute(commands);
  writes_to_host(commands);
}

LevelStats DeviceSelector::stats() const {
  selection_.invalidate();
  const Selection& selection = selection_.mapped<const Selection>()[0];
  return {.bias = selection.step / 8.0,
          .texels = std::uint64_t{selection.texels} << unit_log2_,
          .visible = selection.visible,
          .demoted = selection.demoted};
}

}  // namespace atlaswire::render
