#include "render/atlas_gpu/device_store.h"

#include "base/program.h"
#include "render/atlas/atlas_demand.h"
#include "render/atlas/block_level.h"
#include "render/gpu/barriers.h"
#include "render/gpu/submit_context.h"
#include "shaders/shaders.h"

#include <cmath>
#include <cstring>
#include <string>

namespace atlaswire::render {
namespace {

using namespace alloc;

LevelNumbers numbers_of(const AllocatorSettings& s) { return {s.min_block_log2, s.superblock_log2}; }

Constants constants_of(const AllocatorSettings& s, std::uint32_t patches, std::uint32_t most_new) {
  const std::uint32_t unit_log2 = 2 * s.min_block_log2;
  const auto superblocks = static_cast<std::uint32_t>(s.atlas.area() >> (2 * s.superblock_log2));
  return {.patches = patches,
          .levels = numbers_of(s).count(),
          .min_log2 = s.min_block_log2,
          .max_log2 = s.superblock_log2,
          .grid_width = s.atlas.width >> s.superblock_log2,
          .superblocks = superblocks,
          .high_superblocks = static_cast<std::uint32_t>(std::floor(s.high_water * superblocks)),
          .capacity = static_cast<std::uint32_t>(s.atlas.area() >> unit_log2),
          .regrow_limit = static_cast<std::uint32_t>(high_water_texels(s) >> unit_log2),
          .most_new = most_new};
}

/// A level's stack never holds more than the atlas holds blocks of it.
std::size_t stack_capacity(const AllocatorSettings& s, Level level) {
  return s.atlas.area() >> level.area_log2();
}

std::size_t stack_total(const AllocatorSettings& s) {
  std::size_t total = 0;
  for (std::uint32_t i = 0; i < numbers_of(s).count(); ++i) {
    total += stack_capacity(s, numbers_of(s).level(i));
  }
  return total;
}

std::vector<Binding> bindings() {
  std::vector<Binding> all;
  for (std::uint32_t i = 0; i < 14; ++i) all.push_back({.binding = i});
  return all;
}

}  // namespace

DeviceStore::DeviceStore(Device& device, const AllocatorSettings& settings, std::uint32_t patch_count,
                         SlotOrder order, Residence wants, std::uint32_t most_new)
    : constants_(constants_of(settings, patch_count, most_new)),
      order_(order),
      store_(make(device, "store", sizeof(Store), Residence::kDevice)),
      wants_(make(device, "wants", sizeof(uint) * patch_count, wants)),
      records_(make(device, "records", sizeof(Record) * patch_count, Residence::kDevice)),
      items_(make(device, "items", sizeof(Item) * 2 * patch_count, Residence::kDevice)),
      superblocks_(
          make(device, "superblocks", sizeof(Superblock) * constants_.superblocks, Residence::kDevice)),
      stacks_(make(device, "stacks", sizeof(uint) * stack_total(settings), Residence::kDevice)),
      deferred_(make(device, "deferred", sizeof(Record) * patch_count, Residence::kDevice)),
      tiles_(make(device, "tiles",
                  sizeof(uint) * kCounters * constants_.levels *
                      (group_count(2 * std::uint64_t{patch_count}, kGroup) + std::size_t{1}),
                  Residence::kDevice)),
      events_(make(device, "events", 2 * sizeof(uint) * group_count(patch_count, 32), Residence::kDevice)),
      segments_(make(device, "segments", sizeof(Segment) * kMostSegments, Residence::kDevice)),
      leftovers_(make(device, "leftovers", sizeof(uint) * kMostLevels * kMostLeftovers, Residence::kDevice)),
      changes_(make(device, "changes", sizeof(Change) * patch_count, Residence::kReadback)),
      report_(make(device, "report", sizeof(Report), Residence::kReadback)),
      admitted_(
          make(device, "admitted", sizeof(uint) * (most_new == 0 ? 1 : patch_count), Residence::kDevice)),
      layout_(device, "atlas memory", bindings()),
      sets_(device, "atlas memory", layout_) {
  const Buffer* buffers[] = {&store_, &wants_,  &records_,  &items_,     &superblocks_, &stacks_, &deferred_,
                             &tiles_, &events_, &segments_, &leftovers_, &changes_,     &report_, &admitted_};
  std::uint32_t binding = 0;
  for (const Buffer* buffer : buffers) sets_.write(0, binding++, *buffer);
  upload_initial_state(device, settings);

  using Extent = Pass::Extent;
  const bool ranked = order == SlotOrder::kRanked;
  if (most_new != 0) add_pass(device, "admit", shaders::alloc_admit_comp, Extent::kOne);
  add_pass(device, "request", shaders::alloc_request_comp, Extent::kPatches);
  add_pass(device, "reclaim", shaders::alloc_reclaim_comp, Extent::kOne);
  if (ranked) add_pass(device, "list", shaders::alloc_list_comp, Extent::kEventWords);
  if (ranked) add_pass(device, "rank", shaders::alloc_rank_comp, Extent::kItems);
  add_pass(device, "compact", shaders::alloc_compact_comp, Extent::kCompaction);
  if (ranked) add_pass(device, "count", shaders::alloc_count_comp, Extent::kKeys);
  add_pass(device, "push", shaders::alloc_push_comp, Extent::kItems);
  add_pass(device, "provision", shaders::alloc_provision_comp, Extent::kOne);
  add_pass(device, "assign", shaders::alloc_assign_comp, Extent::kItems);
  add_pass(device, "settle", shaders::alloc_settle_comp, Extent::kOne);
}

Buffer DeviceStore::make(Device& device, const char* name, std::size_t bytes, Residence residence) const {
  if (bytes > device.limits().maxStorageBufferRange) {
    throw ProgramError(ExitCode::kUsage, std::string("atlas memory: its ") + name + " take " +
                                             std::to_string(bytes) +
                                             " bytes, more than a buffer of this device: choose a smaller "
                                             "atlas, larger smallest blocks, or --allocator sequential");
  }
  using Usage = vk::BufferUsageFlagBits;
  return {
      device,
      {.name = std::string("atlas memory: ") + name,
       .size = bytes,
       .usage = Usage::eStorageBuffer | Usage::eTransferSrc | Usage::eTransferDst | Usage::eIndirectBuffer,
       .residence = residence}};
}

void DeviceStore::upload_initial_state(Device& device, const AllocatorSettings& settings) {
  Store store{};
  store.item_groups[1] = store.item_groups[2] = 1;
  store.compact_groups[1] = store.compact_groups[2] = 1;
  store.futile = kSaturated;
  store.free_count = constants_.superblocks;
  std::uint32_t base = 0;
  for (std::uint32_t i = 0; i < constants_.levels; ++i) {
    store.stack_base[i] = base;
    base += static_cast<std::uint32_t>(stack_capacity(settings, numbers_of(settings).level(i)));
  }
  for (uint& superblock : store.tail_superblock) superblock = kNone;
  std::vector<Superblock> superblocks(constants_.superblocks);
  for (std::uint32_t i = 0; i < constants_.superblocks; ++i) {
    superblocks[i].free_stack = constants_.superblocks - 1 - i;
  }
  const auto bytes = [](const auto& data) { return std::as_bytes(std::span(data)); };
  SubmitContext(device, "atlas memory").run([&](const vk::raii::CommandBuffer& commands) {
    const auto fill = [&](const Buffer& buffer, std::span<const std::byte> data) {
      constexpr std::size_t kMostAtOnce = 65536;  // of vkCmdUpdateBuffer
      for (std::size_t at = 0; at < data.size(); at += kMostAtOnce) {
        const auto part = data.subspan(at, std::min(kMostAtOnce, data.size() - at));
        commands.updateBuffer<std::byte>(buffer.handle(), at, part);
      }
    };
    fill(store_, bytes(std::span(&store, 1)));
    fill(superblocks_, bytes(superblocks));
    commands.fillBuffer(wants_.handle(), 0, VK_WHOLE_SIZE, 0);
    commands.fillBuffer(records_.handle(), 0, VK_WHOLE_SIZE, 0);
    commands.fillBuffer(admitted_.handle(), 0, VK_WHOLE_SIZE, 0);
    commands.fillBuffer(events_.handle(), 0, VK_WHOLE_SIZE, 0);
    transfer_to_shaders(commands);
  });
}

void DeviceStore::add_pass(Device& device, const char* name, ShaderWords shader, Pass::Extent extent) {
  passes_.push_back({Pipeline(device, ComputeSettings{.name = std::string("atlas memory: ") + name,
                                                      .shader = shader,
                                                      .layouts = {layout_.handle()},
                                                      .push_constant_bytes = sizeof(Constants),
                                                      .specialization = {{0, order_ == SlotOrder::kDrawn}}}),
                     extent});
}

void DeviceStore::record(const vk::raii::CommandBuffer& commands, std::uint32_t reset) const {
  Constants constants = constants_;
  constants.reset = reset;
  for (const Pass& pass : passes_) {
    pass.pipeline.bind(commands, {sets_.handle()});
    pass.pipeline.push(commands, constants);
    switch (pass.extent) {
      case Pass::Extent::kOne:
        commands.dispatch(1, 1, 1);
        break;
      case Pass::Extent::kPatches:
        commands.dispatch(group_count(constants.patches, kGroup), 1, 1);
        break;
      case Pass::Extent::kEventWords:
        commands.dispatch(group_count(constants.patches, 32 * kGroup), 1, 1);
        break;
      case Pass::Extent::kKeys:
        commands.dispatch(group_count(kCounters * constants.levels, kKeyGroup), 1, 1);
        break;
      case Pass::Extent::kItems:
        commands.dispatchIndirect(store_.handle(), offsetof(Store, item_groups));
        break;
      case Pass::Extent::kCompaction:
        commands.dispatchIndirect(store_.handle(), offsetof(Store, compact_groups));
        break;
    }
    compute_to_compute(commands);
    compute_to_draw(commands);  // later passes take their extent from this one's counts
  }
  writes_to_host(commands);
}

alloc::Report DeviceStore::report() const {
  report_.invalidate();
  return report_.mapped<const Report>()[0];
}

std::span<const alloc::Change> DeviceStore::changes() const {
  const std::uint32_t count = report().changes;
  changes_.invalidate();
  return changes_.mapped<const Change>().first(count);
}

}  // namespace atlaswire::render
