#include "render/atlas_gpu/device_allocator.h"

#include "base/assert.h"
#include "render/atlas/atlas_demand.h"

#include <algorithm>
#include <utility>

namespace atlaswire::render {
namespace {

const AllocatorSettings& checked(const AllocatorSettings& settings) {
  check_allocator_settings(settings);
  return settings;
}

Block block_of(const alloc::Change& change) {
  const std::uint32_t shape = change.what >> 8;
  return {.x = static_cast<std::uint16_t>(change.position & 0xFFFF),
          .y = static_cast<std::uint16_t>(change.position >> 16),
          .width_log2 = static_cast<std::uint8_t>((shape >> 4) & 15),
          .height_log2 = static_cast<std::uint8_t>(shape & 15),
          .transposed = (shape & alloc::kTransposed) != 0};
}

}  // namespace

DeviceAllocator::DeviceAllocator(Device& device, const AllocatorSettings& settings, std::uint32_t patch_count,
                                 SlotOrder order, Residence wants, std::uint32_t most_new)
    : settings_(checked(settings)),
      store_(device, settings, patch_count, order, wants, most_new),
      context_(device, "atlas memory"),
      timer_(device, "atlas memory timer", 1),
      order_(order),
      report_{.free_area =
                  static_cast<std::uint32_t>(settings.atlas.area() >> (2 * settings.min_block_log2))} {}

const LayoutChange& DeviceAllocator::update(std::span<const BlockRequest> visible, bool may_reset) {
  upload(visible);
  context_.run([&](const vk::raii::CommandBuffer& commands) {
    timer_.reset(commands);
    timer_.begin(commands, "atlas memory");
    record(commands, may_reset);
    timer_.end(commands);
  });
  for (const auto& [stage, took] : timer_.collect()) device_time_ += took;
  return collect();
}

void DeviceAllocator::record(const vk::raii::CommandBuffer& commands, bool may_reset) {
  const std::uint32_t otherwise = may_reset ? alloc::kMayReset : 0;
  store_.record(commands, std::exchange(restarts_, false) ? alloc::kMustReset : otherwise);
}

void DeviceAllocator::upload(std::span<const BlockRequest> visible) {
  const auto words = wants().mapped<std::uint32_t>();
  AW_ASSERT(visible.empty() || !words.empty());
  for (const PatchId patch : shown_) words[value(patch)] = 0;
  shown_.clear();
  for (const BlockRequest& request : visible) {
    AW_ASSERT(shown_.empty() || shown_.back() < request.patch);
    shown_.push_back(request.patch);
    const auto [longer, shorter] = std::minmax(request.width_log2, request.height_log2, std::greater{});
    const auto width = std::clamp<std::uint32_t>(longer, settings_.min_block_log2, settings_.superblock_log2);
    const auto height = std::clamp<std::uint32_t>(shorter, settings_.min_block_log2, width);
    words[value(request.patch)] =
        alloc::kWantVisible | (request.transposed ? alloc::kTransposed : 0) | width << 4 | height;
  }
  wants().flush();
}

const LayoutChange& DeviceAllocator::collect() {
  report_ = store_.report();
  change_.reset = report_.reset != 0;
  change_.added.clear();
  change_.moved.clear();
  change_.removed.clear();
  change_.refused.clear();
  for (const alloc::Change& change : store_.changes()) {
    const PatchId patch{change.patch_id};
    if ((change.what & alloc::kAdded) != 0) change_.added.push_back({patch, block_of(change)});
    if ((change.what & alloc::kMoved) != 0) change_.moved.push_back({patch, block_of(change)});
    if ((change.what & alloc::kRemoved) != 0) change_.removed.push_back(patch);
    if ((change.what & alloc::kRefused) != 0) change_.refused.push_back(patch);
  }
  if (order_ == SlotOrder::kDrawn) {
    std::ranges::sort(change_.added, {}, &PlacedPatch::patch);
    std::ranges::sort(change_.moved, {}, &PlacedPatch::patch);
    std::ranges::sort(change_.removed);
    std::ranges::sort(change_.refused);
  }
  live_.apply(change_);
  return change_;
}

AtlasUsage DeviceAllocator::usage() const {
  const auto texels = [&](std::uint32_t smallest) {
    return std::uint64_t{smallest} << (2 * settings_.min_block_log2);
  };
  return {.allocated = texels(report_.allocated),
          .partial_tail = texels(report_.partial_tail),
          .on_stacks = texels(report_.on_stacks),
          .free = texels(report_.free_area)};
}

}  // namespace atlaswire::render
