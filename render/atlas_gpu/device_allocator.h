#pragma once

#include "render/atlas/allocator.h"
#include "render/atlas/live_blocks.h"
#include "render/atlas_gpu/device_store.h"
#include "render/gpu/gpu_timer.h"
#include "render/gpu/submit_context.h"

#include <memory>
#include <vector>

namespace atlaswire::render {

/// The atlas's memory on the device behind the allocators' interface. With ranked slots its results equal
/// the sequential model's, block for block. A frame is either one update(), which waits for the device, or
/// record() into a submission that also makes the wants, and collect() when that is done.
class DeviceAllocator final : public AtlasAllocator {
 public:
  /// Throws ProgramError for settings that do not fit together or the device. `wants`: kDevice where earlier
  /// passes write them. `most_new`: as Admission has it; what waits is not asked for.
  DeviceAllocator(Device& device, const AllocatorSettings& settings, std::uint32_t patch_count,
                  SlotOrder order = SlotOrder::kRanked, Residence wants = Residence::kUpload,
                  std::uint32_t most_new = 0);

  /// Only with wants on the host.
  const LayoutChange& update(std::span<const BlockRequest> visible, bool may_reset) override;

  /// What each patch wants, for an earlier pass to write (alloc_layout.h); levels must be legal.
  [[nodiscard]] const Buffer& wants() const { return store_.wants(); }
  void record(const vk::raii::CommandBuffer& commands, bool may_reset);
  /// The recorded frame's change, once it was waited for.
  const LayoutChange& collect();

  /// Patches that the last frame did not admit.
  [[nodiscard]] std::uint32_t waiting() const { return report_.waiting; }

  /// What all update() calls took on the device; zero where it has no timestamps.
  [[nodiscard]] Duration device_time() const { return device_time_; }

  void restart() override { restarts_ = true; }
  [[nodiscard]] std::vector<PlacedPatch> blocks() const override { return live_.blocks(); }
  [[nodiscard]] AtlasUsage usage() const override;
  [[nodiscard]] bool wants_reset() const override { return report_.wants_reset != 0; }

 private:
  void upload(std::span<const BlockRequest> visible);

  AllocatorSettings settings_;
  DeviceStore store_;
  SubmitContext context_;
  GpuTimer timer_;
  Duration device_time_{};
  SlotOrder order_;
  std::vector<PatchId> shown_;  ///< whose wants the last update wrote
  alloc::Report report_;
  LiveBlocks live_;
  LayoutChange change_;
  bool restarts_ = false;
};

}  // namespace atlaswire::render
